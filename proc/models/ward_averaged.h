#pragma once
// Ward's anisotropic Gaussian [Ward1992, eq. 5] averaged over the sample's rotation about its
// normal: what a rig that lights from one azimuth sees of a surface whose grain has no direction of
// its own. With t = tan(theta_h), p = 1/ax^2, q = 1/ay^2 the mean over phi of
// exp(-t^2 (p cos^2 phi + q sin^2 phi)) is exp(-t^2 (p + q) / 2) I0(t^2 (p - q) / 2)
// [Abramowitz1972, 9.6.16]:
//   f = ks exp(-t^2 min(p, q)) I0e(t^2 |p - q| / 2) / (4 pi ax ay sqrt(mu_i mu_o)),
// I0e(z) = exp(-z) I0(z). Isotropic and reciprocal; at ax = ay Ward's own lobe. alpha in [1e-7, 1].

#include "proc/models/normal_distribution.h"
#include "proc/models/sampling.h"

namespace gonio::proc {

/// exp(-z) I0(z), z >= 0: the ascending series, whose terms are all positive [Abramowitz1972,
/// 9.6.12], to z = 20; beyond it the asymptotic one [Abramowitz1972, 9.7.1], 1e-16 there.
template <class P>
[[nodiscard]] P scaledBessel0(const P& z) {
    using std::exp;
    using std::sqrt;
    P term(1);
    P sum(1);
    if (z < P(20)) {
        const P quarter = z * z * P(0.25);
        for (int k = 1; k < 60 && term > sum * P(1e-17); ++k) {
            term = term * quarter / P(k * k);
            sum = sum + term;
        }
        return exp(-z) * sum;
    }
    const P inverse = P(0.125) / z;
    for (int k = 1; k < 30 && term > P(1e-17); ++k) {
        const int odd = 2 * k - 1;
        term = term * inverse * P(odd * odd) / P(k);
        sum = sum + term;
    }
    return sum / sqrt(P(2 * kPi) * z);
}

template <class P>
struct WardAveraged {
    Bands<P> ks;
    Alpha<P> alpha;

    static constexpr bool kByEffort = true;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const Half<D> half(pair);
        const D tan2 = half.tan2();
        const P p = P(1) / (alpha.x * alpha.x);
        const P q = P(1) / (alpha.y * alpha.y);
        const P least = p < q ? p : q;
        const P most = p < q ? q : p;
        // Where the exponential is 0 the series would have terms without bound.
        const P fall = expOf<E>(P(-tan2 * least));
        if (!(fall > P(0))) return Bands<P>::all(P(0));
        const P e = fall * scaledBessel0(P((most - least) * (tan2 * D(0.5))));
        return ks * P(e / (P(4 * kPi) * alpha.x * alpha.y * std::sqrt(pair.in.z * pair.out.z)));
    }

    /// By the wider width: it covers both.
    [[nodiscard]] LobeMixture lobes() const {
        const auto widest = static_cast<double>(alpha.x < alpha.y ? alpha.y : alpha.x);
        return {{meanOf(ks), BeckmannLobe{Alpha<double>::isotropic(widest)}}};
    }
};

}  // namespace gonio::proc
