#pragma once
// The random pairs that look-ups are judged over, both directions within 89 degrees of the normal;
// a seed gives the same pairs everywhere.

#include <cstddef>
#include <vector>

#include "proc/core/direction.h"

namespace gonio::proc {

struct PairDraw {
    std::size_t count = 0;
    unsigned seed = 1;
};

/// Cosine-distributed, wi and wo independent: where a scene's light goes. Few fall into a lobe.
[[nodiscard]] std::vector<LightView> cosinePairs(const PairDraw& draw);

/// theta_i even in 0..89 degrees, ln(tan(theta_h)) even from exp(-3) to exp(2.5) lobe widths
/// (`width` is a tan(theta_h)), about the half vector at any azimuth: the peak and its flanks.
[[nodiscard]] std::vector<LightView> lobePairs(const PairDraw& draw, double width);

}  // namespace gonio::proc
