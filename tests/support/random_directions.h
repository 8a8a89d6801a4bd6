#pragma once
// Directions above the horizon, drawn with a seed.

#include <cmath>
#include <random>

#include "proc/core/direction.h"

namespace gonio::test {

/// Uniform over the hemisphere's solid angle.
inline Direction randomDirection(std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    const double cosTheta = 1 - unit(random);
    return Direction::fromSpherical(Radians(std::acos(cosTheta)), Radians(2 * kPi * unit(random)));
}

}  // namespace gonio::test
