#pragma once
// Walter's rough dielectric, its reflection: GGX with separable Smith masking and the exact Fresnel
// term [Walter2007, eqs. 20, 22, 33, 34], alpha in [1e-7, 1], eta > 0 (1 reflects nothing).
// Reciprocal; what it does not reflect it transmits. (Steps where the seed prints max(0, h.n) and
// max(0, (w.h)/(w.n)): both are 1 above the horizon.)

#include "proc/models/ggx.h"
#include "proc/models/sampling.h"

namespace gonio::proc {

template <class P>
struct Walter {
    P alpha;
    Bands<P> eta;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const Half<D> half(pair);
        const Alpha<P> both = Alpha<P>::isotropic(alpha);
        const P lobe = ggxD(half, both) * ggxV(pair, both, Masking::Separable);
        return eta.each(
            [&](const P& one) { return P(fresnelDielectric(one, half.cosDiff) * lobe); });
    }

    [[nodiscard]] LobeMixture lobes() const {
        return {{1, GgxLobe{Alpha<double>::isotropic(alpha)}}};
    }
};

}  // namespace gonio::proc
