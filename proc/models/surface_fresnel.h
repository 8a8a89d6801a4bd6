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

/// One form, known when a loop over an array is compiled: a choice within it would keep it scalar.
template <FresnelForm Form, class P>
struct FresnelOfForm {
    Bands<P> f0;
    Bands<P> eta;
    Bands<P> k;

    template <class D>
    [[nodiscard]] Bands<P> at(const D& cosine) const {
        if constexpr (Form == FresnelForm::Schlick) {
            const D weight = schlickWeight(cosine);
            return f0.each([&](const P& one) { return P(one + (P(1) - one) * weight); });
        } else if constexpr (Form == FresnelForm::Dielectric) {
            return eta.each([&](const P& one) { return fresnelDielectric(one, cosine); });
        } else {
            const auto one = [&](const P& n, const P& extinction) {
                return fresnelConductor(ComplexIndex<P>{n, extinction}, cosine);
            };
            return {one(eta.r, k.r), one(eta.g, k.g), one(eta.b, k.b)};
        }
    }
};

template <class P>
struct SurfaceFresnel {
    FresnelForm form = FresnelForm::Schlick;
    Bands<P> f0;   ///< schlick
    Bands<P> eta;  ///< dielectric, conductor
    Bands<P> k;    ///< conductor

    /// Calls with the FresnelOfForm that this is.
    template <class Call>
    auto withForm(Call&& call) const {
        switch (form) {
            case FresnelForm::Schlick:
                return call(FresnelOfForm<FresnelForm::Schlick, P>{f0, eta, k});
            case FresnelForm::Dielectric:
                return call(FresnelOfForm<FresnelForm::Dielectric, P>{f0, eta, k});
            case FresnelForm::Conductor: break;
        }
        return call(FresnelOfForm<FresnelForm::Conductor, P>{f0, eta, k});
    }

    template <class D>
    [[nodiscard]] Bands<P> at(const D& cosine) const {
        return withForm([&](const auto& fresnel) { return fresnel.at(cosine); });
    }
};

}  // namespace gonio::proc
