#pragma once
// Where the lobe of a table really stands: a check of a file's azimuth convention. Most surfaces
// scatter more toward the mirror direction than back or sideways; retroreflectors do not, so that
// this is a reason to warn, never to turn the data.

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "proc/table/spherical_table.h"

namespace gonio::proc {

/// Of the reflection blocks at incidences of 10 to 75 degrees, how many are largest at theta =
/// incidence and azimuth = mirror + 0, 90, 180, 270 degrees, by at least 1.2 times any other of the
/// four. Blocks without such a winner, or without nodes near the four (7.5 degrees), do not count.
[[nodiscard]] std::array<std::size_t, 4> peakQuarters(const SphericalTable& table);

/// One sentence where more blocks have their peak elsewhere than at the mirror direction.
[[nodiscard]] std::optional<std::string> peakWarning(const SphericalTable& table);

}  // namespace gonio::proc
