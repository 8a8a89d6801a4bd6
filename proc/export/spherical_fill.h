#pragma once
// A SphericalTable made by asking a Scatterer at each node. A node without an answer is NaN. TIS is
// the integral of f cos(theta_o) over the hemisphere (totalScatter), where it is wanted.

#include <cstddef>
#include <vector>

#include "proc/core/scatterer.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

/// The same axes for each light direction and channel.
struct SphericalGrid {
    std::vector<double> incidenceDeg, azimuthDeg, thetaDeg;
    std::vector<double> lightAzimuthDeg{0};
    double mirrorAzimuthDeg = 180;
    bool planeSymmetrical = false;
    bool tis = true;
};

struct FilledSpherical {
    SphericalTable table;
    std::size_t nodes = 0;         ///< above the horizon
    std::size_t unanswered = 0;    ///< NaN in the table
    std::size_t extrapolated = 0;  ///< answered from beyond what was measured
};

/// `channels` are R, G, B in this order, or the one of a monochrome surface. Blocks in the order of
/// channels, light azimuths, incidences.
[[nodiscard]] FilledSpherical fillSpherical(const Scatterer& from,
                                            const SphericalGrid& grid,
                                            const std::vector<Channel>& channels);

}  // namespace gonio::proc
