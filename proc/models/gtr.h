#pragma once
// Microfacet reflection with the generalised Trowbridge-Reitz distribution of normals [Burley2012,
// app. B.2]: gamma 2 is GGX, 1 the clearcoat's, less than 2 has longer tails, more shorter ones.
//   D(h) = peak (alpha^2 / (sin^2 + alpha^2 cos^2))^gamma,
//   peak = (gamma - 1) (1 - alpha^2) / (pi (alpha^2 - alpha^(2 gamma))), its limits at gamma = 1
//   and at alpha = 1: the integral of D cos(theta_h) is 1.
// alpha in [1e-7, 1], gamma in [0.5, 10]. There is no closed form of Smith's masking for it: GGX's
// of the same alpha stands in, as Burley does. Reciprocal. Single scattering only.

#include "proc/models/masking.h"
#include "proc/models/sampling.h"
#include "proc/models/surface_fresnel.h"

namespace gonio::proc {

/// D at the normal, 1/sr.
template <class P>
[[nodiscard]] P gtrPeak(const P& alpha, const P& gamma) {
    using std::expm1;
    using std::log;
    const P logA2 = P(2) * log(alpha);
    const P power = gamma - P(1);
    // Near alpha = 1 both differences below vanish: their quotient as a series.
    if (logA2 > P(-1e-4)) {
        const P q = power * logA2;
        const P quotient =
            (P(1) + logA2 / P(2) + logA2 * logA2 / P(6)) / (P(1) + q / P(2) + q * q / P(6));
        return quotient / (P(kPi) * alpha * alpha);
    }
    // (1 - alpha^(2 (gamma - 1))) / (gamma - 1), without a difference.
    const P rest = power == P(0) ? P(-logA2) : P(-expm1(power * logA2) / power);
    return -expm1(logA2) / (P(kPi) * alpha * alpha * rest);
}

template <class P>
struct Gtr {
    P alpha;
    P gamma;
    P peak;  ///< gtrPeak(alpha, gamma)
    SurfaceFresnel<P> fresnel;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        using std::pow;
        const Half<D> half(pair);
        const P a2 = alpha * alpha;
        const P d = peak * pow(P(a2 * half.length2 / (half.sin2 + a2 * half.cos2)), gamma);
        return fresnel.at(half.cosDiff) *
               P(d * ggxV(pair, Alpha<P>::isotropic(alpha), Masking::HeightCorrelated));
    }

    [[nodiscard]] LobeMixture lobes() const {
        const auto a = static_cast<double>(alpha);
        return {{0.5, GgxLobe{Alpha<double>::isotropic(a)}}, {0.5, Gtr1Lobe{a}}};
    }
};

}  // namespace gonio::proc
