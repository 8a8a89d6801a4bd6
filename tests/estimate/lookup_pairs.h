#pragma once
// The random pairs that look-ups are judged over, both directions within 89 degrees of the normal.

#include <cmath>
#include <random>
#include <vector>

#include "proc/core/direction.h"

namespace gonio::test {

/// Cosine-distributed and independent.
inline std::vector<LightView> cosinePairs(std::size_t count, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit;
    const auto drawn = [&] {
        const double sine = std::sqrt(unit(random)) * sin(89_deg);
        return Direction::fromSpherical(Radians(std::asin(sine)), Radians(2 * kPi * unit(random)));
    };
    std::vector<LightView> pairs;
    while (pairs.size() < count) pairs.push_back({drawn(), drawn()});
    return pairs;
}

}  // namespace gonio::test
