#pragma once
// Transmission as most files have it: theta counted from the normal of the side on which the view
// lies, [0, 90]. A SphericalBlock counts it from the light's side, from 90 to 180.

#include <vector>

#include "proc/table/spherical_table.h"

namespace gonio::proc {

/// Thetas t become 180 - t, and both they and the values are brought into ascending order.
void turnOver(SphericalBlock& block);

/// Ascending, rounded as files are; of reflection the block's own.
[[nodiscard]] std::vector<double> thetasFromOwnNormal(const SphericalBlock& block);

}  // namespace gonio::proc
