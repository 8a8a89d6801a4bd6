#pragma once
// Cook and Torrance's microfacets in V grooves [CookTorrance1982], as published:
//   f = F G D / (pi mu_i mu_o), D = exp(-(tan(theta_h) / m)^2) / (m^2 cos^4(theta_h)),
//   G = min(1, 2 cos(theta_h) mu_o / (wo.h), 2 cos(theta_h) mu_i / (wo.h)).
// D lacks the 1/pi of a normalised distribution and f has pi where later models have 4: it is 4
// times F G D / (4 mu_i mu_o) of today, so that directional albedo reaches 4 f0 on a rough-free
// surface. Kept literal because fits are published in it; `ks` scales it (ks = 1/4 conserves
// energy).
//   cook-torrance(m, f0)     F by Schlick from f0
//   low(roughness, eta)      F exact for a dielectric, the form of the fits in [Low2012]
// m in [1e-7, 1], roughness in [1e-7, 10]. Reciprocal.

#include "proc/models/fresnel.h"
#include "proc/models/normal_distribution.h"
#include "proc/models/sampling.h"

namespace gonio::proc {

/// G D / (pi mu_i mu_o), D without its 1/pi.
template <Effort E, class P, class D>
[[nodiscard]] P grooveLobe(const P& m, const Pair<D>& pair, const Half<D>& half) {
    // G / (mu_i mu_o) = min(1 / (mu_i mu_o), 2 cos(theta_h) / (cos_d max(mu_i, mu_o))), and
    // 2 cos(theta_h) / cos_d = 4 Hz / |H|^2.
    const D masked = std::min(D(1) / (pair.in.z * pair.out.z),
                              D(4) * half.h.z / half.length2 / std::max(pair.in.z, pair.out.z));
    const HalfSquares<D> squares{half.sin2, half.cos2};
    return beckmannD<E>(squares, m) * masked;
}

template <class P>
struct CookTorrance {
    P m;
    Bands<P> f0;
    Bands<P> ks;

    static constexpr bool kByEffort = true;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const Half<D> half(pair);
        const P lobe = grooveLobe<E>(m, pair, half);
        const Bands<P> fresnel =
            f0.each([&](const P& one) { return schlick(one, P(1), half.cosDiff); });
        return ks * fresnel * lobe;
    }

    [[nodiscard]] LobeMixture lobes() const {
        return {{meanOf(ks), BeckmannLobe{Alpha<double>::isotropic(m)}}};
    }
};

template <class P>
struct Low {
    P roughness;
    Bands<P> eta;
    Bands<P> ks;

    static constexpr bool kByEffort = true;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const Half<D> half(pair);
        const P lobe = grooveLobe<E>(roughness, pair, half);
        const Bands<P> fresnel =
            eta.each([&](const P& one) { return fresnelDielectric(one, half.cosDiff); });
        return ks * fresnel * lobe;
    }

    [[nodiscard]] LobeMixture lobes() const {
        return {{meanOf(ks), BeckmannLobe{Alpha<double>::isotropic(roughness)}}};
    }
};

}  // namespace gonio::proc
