#pragma once
// What a block's own numbers say is scattered: the integral of f cos(theta) over the directions
// that its axes cover, f linear in theta and in azimuth between the nodes. Exact for f = const,
// whatever the steps. A node without data counts as 0, so that a masked rim gives the share of the
// rest. NaN where the azimuths cover neither the circle nor, plane-symmetrical, half of it; at
// incidence 0 a single azimuth stands for the circle.

#include "proc/table/spherical_table.h"

namespace gonio::proc {

/// Fraction of the incident power.
[[nodiscard]] double blockIntegral(const SphericalTable& table, const SphericalBlock& block);

}  // namespace gonio::proc
