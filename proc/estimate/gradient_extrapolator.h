#pragma once
// Beyond the edge a bent gradient from the value at the edge to a part of it [Cezner2023, eq. 39
// and 40: GradientExtrapolator]. With w_b the direction at the edge and d = |w - w_b|,
//
//     f(w) = (1 - t) f(w_b) + t p f(w_b),    t = b(d / m, l),
//
// where eq. 39 prints w_b for the second f(w_b), and b is the quadratic Bezier curve through (0, 0)
// and (1, 1) with its middle point at (l, 1 - l), as y over x:
//
//     b(x, l) = 2 (1 - s) s (1 - l) + s^2   where   x = 2 (1 - s) s l + s^2.
//
// l = 0.5: a straight line; l < 0.5 falls fast first, l > 0.5 late. At d >= m: p f(w_b). d is the
// chord between the two directions, 2 sin(half the angle).

#include "proc/estimate/extrapolator.h"

namespace gonio::proc {

struct GradientOptions {
    double ratio = 0.2;      ///< p, at least 0
    double distance = 0.26;  ///< m, above 0: about the chord of 15 degrees
    double bend = 0.3;       ///< l, in [0, 1]
};

/// b(x, l) of eq. 40; x and l in [0, 1].
[[nodiscard]] double bentStep(double x, double bend);

/// A Usage error for an edge outside [0, 90) degrees and for options out of their domain.
[[nodiscard]] Result<std::unique_ptr<Scatterer>> makeGradientExtrapolator(
    std::unique_ptr<Scatterer> inner,
    const Beyond& beyond = {},
    const GradientOptions& options = {});

}  // namespace gonio::proc
