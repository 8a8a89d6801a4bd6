#pragma once
// The native sample file `.gonio` (DESIGN.md 4): an OpenEXR multi-part file, one part per LED and
// band (led0.r, led0.g, ...), each 90 rows x 360 columns. Row k is theta_o in [k, k + 1) degrees;
// column j, phi in [j, j + 1), repeats the cell that holds its centre, whose number is in cell_id.
// Channels f, u_random, u_systematic, n_eff (FLOAT), flags, cell_id (UINT); everything about the
// sample stands as text attributes of the first part. A table of a turned sample says so in the
// attribute gonio.rotation_deg of its parts, in [0, 360); absent: 0. The tables of a sample that
// was measured at several rotations follow one another, rotation by rotation.
//
// Values are stored as float: writing rounds once, and from then on write-read-write gives the same
// bits. NaN is missing; an infinite value is refused.

#include <filesystem>
#include <string>
#include <string_view>

#include "proc/core/result.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

inline constexpr std::string_view kSampleSchema = "gonio/sample/1";

/// Internal error for a set without any measured band, with more tables than that, whose cells are
/// not CellGrid's or not all within a float's range. A number of the info that is not finite is
/// left out.
[[nodiscard]] Result<std::string> encodeGonio(const SampleSet& set);
/// `name` stands in errors: "gonio: NAME: part led0.r: ...".
[[nodiscard]] Result<SampleSet> decodeGonio(std::string_view bytes, std::string_view name);

[[nodiscard]] Result<void> writeGonio(const std::filesystem::path& path, const SampleSet& set);
[[nodiscard]] Result<SampleSet> readGonio(const std::filesystem::path& path);

}  // namespace gonio::proc
