#pragma once
// An LED as the sample sees it: an even disc. A mean over the disc is that of seven points with
// weights, exact for polynomials up to the fifth degree [Radon's rule]: a quarter of the weight in
// the middle, an eighth on each of six at sqrt(2/3) of the radius. Where f changes by much within
// half the disc it is no longer good: a GGX lobe of alpha = 0.02 under a disc of one degree is
// right to 1e-3 of its peak, one of 0.005 only to some per cent.

#include <array>

#include "proc/core/direction.h"
#include "proc/core/units.h"

namespace gonio::sim {

struct SourcePoint {
    Direction direction;
    double weight = 0;
};

inline constexpr std::size_t kSourcePoints = 7;

/// The points of a disc about `middle`; the first is the middle itself. The directions are on the
/// cone of the points' angle about the middle.
[[nodiscard]] std::array<SourcePoint, kSourcePoints> sourceDisc(const Direction& middle,
                                                                Radians diameter);

}  // namespace gonio::sim
