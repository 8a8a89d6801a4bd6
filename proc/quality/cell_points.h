#pragma once
// Where to look at a smooth function for its mean over a cell: Gauss points of equal areas, two
// each way. Exact to the third order in the cosine of theta and in phi: a lobe of one degree is
// right to a fraction of a per cent where its value in the middle of the cell is off by several.

#include <array>
#include <cmath>

#include "proc/optics/cell_grid.h"

namespace gonio::proc {

/// The mean of a function over the cell is that of its values in these directions.
[[nodiscard]] inline std::array<Direction, 4> pointsOver(std::size_t cell) {
    const CellBounds at = CellGrid::bounds(cell);
    const double gauss = 0.5 / std::sqrt(3.0);
    const double top = cos(at.thetaLow), bottom = cos(at.thetaHigh);
    const auto point = [&](double i, double j) {
        return Direction::fromSpherical(Radians(std::acos(top + (bottom - top) * (0.5 + i))),
                                        at.phiLow + (at.phiHigh - at.phiLow) * (0.5 + j));
    };
    return {point(-gauss, -gauss), point(-gauss, gauss), point(gauss, -gauss), point(gauss, gauss)};
}

}  // namespace gonio::proc
