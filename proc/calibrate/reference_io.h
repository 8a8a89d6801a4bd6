#pragma once
// Reference tables as text: comment lines "# key: value" (name, citation, licence, u_common,
// u_per_direction; others are ignored), then CSV with theta_i,theta_o,phi_o in degrees and
// f_r,f_g,f_b in 1/sr, one row per node of a full grid for each incidence, in any order.

#include <filesystem>
#include <string_view>

#include "proc/calibrate/reference.h"

namespace gonio::proc {

/// File errors name the file and the line.
[[nodiscard]] Result<ReferenceTable> readReference(const std::filesystem::path& file);
[[nodiscard]] Result<ReferenceTable> parseReference(std::string_view text);

}  // namespace gonio::proc
