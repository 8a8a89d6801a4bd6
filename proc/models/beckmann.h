#pragma once
// Microfacet reflection with Beckmann's distribution of normals [Walter2007, eq. 25]:
//   f = D(h) V(wi, wo) F(wi.h), V = G2 / (4 mu_i mu_o),
// with Smith's exact masking (its rational fit at draft effort); the `fast` masking is GGX's and
// not offered here. alpha in [1e-7, 1]. Reciprocal. Single scattering only.

#include "proc/models/masking.h"
#include "proc/models/sampling.h"
#include "proc/models/surface_fresnel.h"

namespace gonio::proc {

template <class P>
struct Beckmann {
    Alpha<P> alpha;
    SurfaceFresnel<P> fresnel;
    Masking masking = Masking::HeightCorrelated;

    static constexpr bool kByEffort = true;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const Half<D> half(pair);
        const Cosines<P> lambda{beckmannLambda<E>(slope2(pair.in, alpha)),
                                beckmannLambda<E>(slope2(pair.out, alpha))};
        return fresnel.at(half.cosDiff) *
               P(beckmannD<E>(half, alpha) * smithV(pair, lambda, masking));
    }

    [[nodiscard]] LobeMixture lobes() const { return {{1, BeckmannLobe{alpha}}}; }
};

}  // namespace gonio::proc
