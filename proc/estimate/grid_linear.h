#pragma once
// A matrix of values for each plane of incidence, filled by another estimator, and linear
// interpolation between them [Cezner2023, 6.1.3: GridInterpolator, and the settings of 6.2]: linear
// in theta_i between two planes, at equal grid coordinates, and bilinear within each. Isotropic:
// azimuths count from the light's.
//
// Origin up: theta_o and phi_o. Origin specular: radial and azimuth about the mirror direction
// (proc/core/coordinates.h), so that a lobe that follows the mirror direction stays in its place.
//
// A node below the horizon, or without an answer, is missing; between nodes the others take over
// its weight, as long as they have at least half of all: else no answer. Of one node alone the
// answer is the node's own, source measured where it was that. Below the first and above the last
// plane: no answer.

#include <memory>
#include <vector>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"

namespace gonio::proc {

enum class GridOrigin {
    Up,
    Specular
};

struct GridLinearOptions {
    std::vector<Radians> incidences;  ///< ascending, at least 1e-9 degrees apart
    GridOrigin origin = GridOrigin::Specular;
    std::size_t rows = 181;     ///< from the origin: to 90 degrees (up), to 180 (specular)
    std::size_t columns = 360;  ///< of a full turn
};

/// Asks `inner` at each node above the horizon, on all cores: it must stand that. A Usage error for
/// no or unordered incidences, incidences outside [0, 90) degrees, fewer than 2 rows or 1 column,
/// and more than 20 million nodes.
[[nodiscard]] Result<std::unique_ptr<Scatterer>> makeGridLinear(const Scatterer& inner,
                                                                const GridLinearOptions& options);

}  // namespace gonio::proc
