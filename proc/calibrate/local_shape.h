#pragma once
// How f runs about a cell, to second order in the angles x along theta and y along phi (radians on
// the sphere), from the cells beside it one degree away:
//     g(x, y) = g + a x + b y + (c x^2 + d y^2) / 2.
// g is ln f where f stands above its noise in all cells that are needed, and f elsewhere: the flank
// of a lobe falls by a factor from cell to cell, of which differences of f make far too much. The
// neighbour in the next row is linear in phi between the two cells there.
//
// A direction with one neighbour has a slope and no curvature; with none, neither.

#include <cstddef>

#include "proc/calibrate/cell_samples.h"
#include "proc/core/direction.h"

namespace gonio::proc {

/// Along one of the two directions: of f in 1/sr (or of ln f) per radian and per radian squared.
struct LocalCurve {
    double slope = 0;
    double curvature = 0;
};

struct LocalShape {
    bool logarithmic = false;  ///< of ln f
    LocalCurve theta, phi;

    /// |grad f| in 1/sr per radian at a cell of this f.
    [[nodiscard]] double slope(double f) const;
    /// Of f by first order, for errors of the direction of size `u`.
    [[nodiscard]] double firstOrder(double f, const DirectionSpread& u) const;
    /// Sum of the second derivatives of f along theta and phi, 1/sr per radian squared.
    [[nodiscard]] double laplacian(double f) const;
    /// f at so many radians from the cell's centre.
    [[nodiscard]] double at(double f, double alongTheta, double alongPhi) const;
    /// Root mean square, over errors of the direction of size u, of what the second order adds to
    /// f.
    [[nodiscard]] double secondOrder(double f, const DirectionSpread& u) const;

private:
    [[nodiscard]] double second(double f, const LocalCurve& along) const;
};

/// Reads f, uRandom and flags of the cell, which is present, and its neighbours.
[[nodiscard]] LocalShape localShape(const CellSamples& cells, std::size_t cell);

}  // namespace gonio::proc
