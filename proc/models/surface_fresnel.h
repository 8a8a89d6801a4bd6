#pragma once
// The Fresnel term of a microfacet model, one per band, from what a user gives: f0, or eta with k.
//   schlick  f0 + (1 - f0)(1 - c)^5
//   exact    the dielectric of eta, or the conductor of eta and k; from f0 the dielectric with
//            eta = (1 + sqrt(f0)) / (1 - sqrt(f0)), and f0 = 1 reflects all.

#include "proc/models/fresnel.h"

namespace gonio::proc {

enum class FresnelForm {
    Schlick,
    Dielectric,
    Conductor
};

template <class P>
struct SurfaceFresnel {
    FresnelForm form = FresnelForm::Schlick;
    Bands<P> f0;   ///< schlick
    Bands<P> eta;  ///< dielectric, conductor
    Bands<P> k;    ///< conductor

    template <class D>
    [[nodiscard]] Bands<P> at(const D& cosine) const {
        switch (form) {
            case FresnelForm::Schlick: {
                const D weight = schlickWeight(cosine);
                return f0.each([&](const P& one) { return P(one + (P(1) - one) * weight); });
            }
            case FresnelForm::Dielectric:
                return eta.each([&](const P& one) { return fresnelDielectric(one, cosine); });
            case FresnelForm::Conductor: break;
        }
        const auto one = [&](const P& n, const P& extinction) {
            return fresnelConductor(ComplexIndex<P>{n, extinction}, cosine);
        };
        return {one(eta.r, k.r), one(eta.g, k.g), one(eta.b, k.b)};
    }
};

}  // namespace gonio::proc
