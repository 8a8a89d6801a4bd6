#pragma once
// Beyond the edge a quadratic Bezier curve over theta, from the value at the edge along the data's
// tangent there to 0 at 90 degrees [Cezner2023, 4.1.3 item 4 and figure 11]. Its control points:
//
//     P0 = (edge, f),  P1 = (middle of edge and 90, f + f' (90 - edge) / 2),  P2 = (90, 0).
//
// The thesis gives P0, P2 and the tangent; P1 in the middle is our choice: theta is then linear in
// the curve's parameter. The tangent f' is the difference over the last `step` before the edge, so
// that noise there is widened by (90 - edge) / (2 step): u says so. A P1 below 0 would make f
// negative and is held at 0 (at f where that is below 0, as noise can be).

#include "proc/estimate/extrapolator.h"

namespace gonio::proc {

struct BezierOptions {
    Radians step = 1_deg;
};

/// A Usage error for an edge outside [0, 90) degrees and for a step that is not above 0 or leads
/// below theta = 0.
[[nodiscard]] Result<std::unique_ptr<Scatterer>> makeBezierExtrapolator(
    std::unique_ptr<Scatterer> inner, const Beyond& beyond = {}, const BezierOptions& options = {});

}  // namespace gonio::proc
