#pragma once
// An isotropic BRDF on a grid of half/difference angles [Rusinkiewicz1998], as MERL files hold it
// [Matusik2003]: theta_half by its root (the grid is densest where a lobe is), theta_diff and
// phi_diff evenly, R, G and B in 1/sr. A value stands at the lower edge of its cell:
//
//   theta_half = 90 deg (h / H)^2,  theta_diff = 90 deg d / D,  phi_diff = span p / P
//
// The span of phi_diff is 180 degrees, whose other half is the same by reciprocity, or the whole
// circle. theta_half and theta_diff end one node before 90 degrees. NaN: no data.

#include <array>
#include <cstddef>
#include <vector>

#include "proc/core/direction.h"

namespace gonio::proc {

/// Positions on the three axes.
struct HalfDifferenceNode {
    std::size_t thetaHalf = 0, thetaDiff = 0, phiDiff = 0;
};

struct HalfDifferenceTable {
    std::size_t thetaHalfCount = 90, thetaDiffCount = 90, phiDiffCount = 180;
    bool wholeCircle = false;  ///< phi_diff covers 360 degrees, not 180
    /// R, G, B in 1/sr, theta_half > theta_diff > phi_diff (fastest).
    std::array<std::vector<double>, 3> planes;

    /// Nodes of one plane.
    [[nodiscard]] std::size_t nodeCount() const {
        return thetaHalfCount * thetaDiffCount * phiDiffCount;
    }
    [[nodiscard]] std::size_t index(const HalfDifferenceNode& node) const {
        return (node.thetaHalf * thetaDiffCount + node.thetaDiff) * phiDiffCount + node.phiDiff;
    }
    /// The inverse of index().
    [[nodiscard]] HalfDifferenceNode nodeAt(std::size_t index) const;
    [[nodiscard]] double phiSpanDeg() const { return wholeCircle ? 360 : 180; }
    /// The light and the view of a node, its half vector at azimuth 0.
    [[nodiscard]] LightView pairAt(const HalfDifferenceNode& node) const;
};

/// Both directions are above the horizon by more than rounding.
[[nodiscard]] bool aboveHorizon(const LightView& pair);

}  // namespace gonio::proc
