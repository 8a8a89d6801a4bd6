#pragma once
// Distributions of microfacet normals D(h), 1/sr, normalised so that the integral of D cos(theta_h)
// over the hemisphere is 1; zero at and below the horizon of h is the caller's (H = wi + wo is
// above it whenever both are). Isotropic and with alpha_x, alpha_y; alpha in [1e-7, 1].
//   GGX       D = 1 / (pi ax ay cos^4 (1 + tan^2_a)^2), tan^2_a = (Hx/(ax Hz))^2 + (Hy/(ay Hz))^2
//             [Trowbridge1975] [Walter2007, eq. 33] [Heitz2014, eq. 84]
//   Beckmann  D = exp(-tan^2_a) / (pi ax ay cos^4) [Walter2007, eq. 25]
//   GTR1      D = (a^2 - 1) / (pi ln(a^2) (1 + (a^2 - 1) cos^2)) [Burley2012, app. B.2]; at a = 1
//             the limit 1/pi.
// From H not normalised all are quotients of sums of squares: no digits are lost down to the
// smallest alpha (float: GGX 5e-7; Beckmann (8 + 4 tan^2_a) ulp, from its exponent).

#include "proc/models/fast_exp.h"
#include "proc/models/kernel.h"

namespace gonio::proc {

template <class P>
struct Alpha {
    P x;
    P y;

    [[nodiscard]] static Alpha isotropic(const P& a) { return {a, a}; }
};

/// Squares of a half vector of any length: sin2 + cos2 = length2.
template <class D>
struct HalfSquares {
    D sin2;
    D cos2;
};

template <class P, class D>
[[nodiscard]] P ggxD(const HalfSquares<D>& h, const P& alpha) {
    const P ratio = alpha * (h.sin2 + h.cos2) / (h.sin2 + alpha * alpha * h.cos2);
    return ratio * ratio * P(1 / kPi);
}

template <class P, class D>
[[nodiscard]] P ggxD(const Half<D>& half, const Alpha<P>& alpha) {
    const P sx = half.h.x / alpha.x;
    const P sy = half.h.y / alpha.y;
    const P ratio = half.length2 / (sx * sx + sy * sy + half.cos2);
    return ratio * ratio / (P(kPi) * alpha.x * alpha.y);
}

template <Effort E, class P, class D>
[[nodiscard]] P beckmannD(const HalfSquares<D>& h, const P& alpha) {
    const D tan2 = h.sin2 / h.cos2;
    const D inverseCos2 = (h.sin2 + h.cos2) / h.cos2;
    const P a2 = alpha * alpha;
    // Exponential first: far out it is 0 before the powers of 1/cos could overflow.
    return expOf<E>(P(-tan2 / a2)) * inverseCos2 * inverseCos2 / (P(kPi) * a2);
}

template <Effort E, class P, class D>
[[nodiscard]] P beckmannD(const Half<D>& half, const Alpha<P>& alpha) {
    const P sx = half.h.x / alpha.x;
    const P sy = half.h.y / alpha.y;
    const D inverseCos2 = half.length2 / half.cos2;
    return expOf<E>(P(-(sx * sx + sy * sy) / half.cos2)) * inverseCos2 * inverseCos2 /
           (P(kPi) * alpha.x * alpha.y);
}

template <class P, class D>
[[nodiscard]] P gtr1D(const HalfSquares<D>& h, const P& alpha) {
    using std::log;
    using std::log1p;
    const P q = (alpha - P(1)) * (alpha + P(1));
    const P logarithm = alpha < P(0.5) ? P(2) * log(alpha) : P(log1p(q));
    const P scale = q < P(0) ? P(q / logarithm) : P(1);
    const D length2 = h.sin2 + h.cos2;
    return scale * length2 / (P(kPi) * (h.sin2 + alpha * alpha * h.cos2));
}

}  // namespace gonio::proc
