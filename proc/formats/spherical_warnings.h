#pragma once
// What the user of a spherical table out of a file should know before believing it.

#include <string>
#include <vector>

#include "proc/table/spherical_table.h"

namespace gonio::proc {

/// Negative values, blocks of a single azimuth, and lobes that stand elsewhere than the azimuth
/// convention has them.
[[nodiscard]] std::vector<std::string> sphericalWarnings(const SphericalTable& table);

}  // namespace gonio::proc
