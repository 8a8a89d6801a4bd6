#include "proc/table/half_difference_table.h"

#include "proc/core/coordinates.h"

namespace gonio::proc {

HalfDifferenceNode HalfDifferenceTable::nodeAt(std::size_t index) const {
    const std::size_t ring = index / phiDiffCount;
    return {.thetaHalf = ring / thetaDiffCount,
            .thetaDiff = ring % thetaDiffCount,
            .phiDiff = index % phiDiffCount};
}

LightView HalfDifferenceTable::pairAt(const HalfDifferenceNode& node) const {
    const auto share = [](std::size_t at, std::size_t count) {
        return static_cast<double>(at) / static_cast<double>(count);
    };
    const double root = share(node.thetaHalf, thetaHalfCount);
    const double phi = share(node.phiDiff, phiDiffCount) * phiSpanDeg();
    return fromHalfDifference(
        {.thetaHalf = Radians::fromDegrees(90 * root * root),
         .phiHalf = {},
         .thetaDiff = Radians::fromDegrees(90 * share(node.thetaDiff, thetaDiffCount)),
         .phiDiff = Radians::fromDegrees(phi)});
}

bool aboveHorizon(const LightView& pair) {
    constexpr double kHorizon = 1e-12;  // cos(90 deg) is 6e-17 in double
    return pair.in.z() > kHorizon && pair.out.z() > kHorizon;
}

}  // namespace gonio::proc
