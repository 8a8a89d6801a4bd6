#pragma once
// Microfacet reflection with the GGX (Trowbridge-Reitz) distribution of normals [Walter2007, eq.
// 33], anisotropic as [Heitz2014, eq. 84]:
//   f = D(h) V(wi, wo) F(wi.h), V = G2 / (4 mu_i mu_o).
// alpha in [1e-7, 1]; masking and Fresnel in the forms of masking.h and surface_fresnel.h. D comes
// from the unnormalised h = wi + wo by components, so that it keeps its digits down to the smallest
// alpha. Reciprocal. Single scattering only: a rough white metal loses energy (E = 1 - ln 2 = 0.307
// at alpha 1, normal incidence); multiple_scattering.h gives it back.

#include "proc/models/masking.h"
#include "proc/models/sampling.h"
#include "proc/models/surface_fresnel.h"

namespace gonio::proc {

/// With the forms of masking and Fresnel known when a loop over an array is compiled.
template <class P, class Fresnel, Masking Form>
struct GgxOfForms {
    Alpha<P> alpha;
    Fresnel fresnel;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const Half<D> half(pair);
        return fresnel.at(half.cosDiff) * P(ggxD(half, alpha) * ggxV(pair, alpha, Form));
    }
};

template <class P>
struct Ggx {
    Alpha<P> alpha;
    SurfaceFresnel<P> fresnel;
    Masking masking = Masking::HeightCorrelated;

    /// Calls with the GgxOfForms that this is.
    template <class Call>
    auto withForms(Call&& call) const {
        return fresnel.withForm([&]<class Fresnel>(const Fresnel& of) {
            switch (masking) {
                case Masking::HeightCorrelated:
                    return call(GgxOfForms<P, Fresnel, Masking::HeightCorrelated>{alpha, of});
                case Masking::Separable:
                    return call(GgxOfForms<P, Fresnel, Masking::Separable>{alpha, of});
                case Masking::Fast: break;
            }
            return call(GgxOfForms<P, Fresnel, Masking::Fast>{alpha, of});
        });
    }

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        return withForms([&](const auto& ggx) { return ggx.template f<E>(pair); });
    }

    [[nodiscard]] LobeMixture lobes() const { return {{1, GgxLobe{alpha}}}; }
};

}  // namespace gonio::proc
