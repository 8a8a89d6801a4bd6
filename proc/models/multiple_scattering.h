#pragma once
// What a rough surface reflects after more than one bounce, added to a single-scattering GGX lobe
// with height-correlated masking (directional_albedo.h):
//   kulla-conty  f_ms = (1 - E_i)(1 - E_o) / (pi (1 - E_avg)) F_avg^2 E_avg / (1 - F_avg (1 -
//   E_avg))
//                [KullaConty2017]. Reciprocal; with F = 1 the albedo is 1 at every incidence.
//   fdez-aguera  f_ms = FmsEms / pi, FmsEms = (1 - E) FssEss F_avg / (1 - F_avg (1 - E)), FssEss =
//                f0 A + B, E, A, B at mu_o [FdezAguera2019]: made for image-based light, so it
//                looks at mu_o alone and is not reciprocal. Schlick's F only. Albedo 1 at F = 1.
// F_avg = 2 int F mu dmu: f0 + (1 - f0) / 21 by Schlick. An anisotropic lobe takes E of sqrt(ax
// ay): its furnace is off by what E differs along and across.

#include <memory>

#include "proc/models/directional_albedo.h"
#include "proc/models/ggx.h"
#include "proc/models/sampling.h"

namespace gonio::proc {

enum class MultipleScattering {
    KullaConty,
    FdezAguera
};

/// F_avg^2 E_avg / (1 - F_avg (1 - E_avg)): the colour of light that bounced.
template <class P>
[[nodiscard]] P bouncedFresnel(const P& averageFresnel, const AverageAlbedo& average) {
    const P lost = averageFresnel * P(average.oneMinusE);
    return averageFresnel * averageFresnel * P(average.e) / (P(1) - lost);
}

/// FmsEms of one band.
template <class P>
[[nodiscard]] P fdezAguera(const P& f0, const DirectionalAlbedo& at) {
    const P single = f0 * P(at.a) + P(at.b);
    const P averageFresnel = f0 + (P(1) - f0) * P(1.0 / 21);
    const P lost = P(at.oneMinusE);
    return lost * single * averageFresnel / (P(1) - averageFresnel * lost);
}

/// 2 int F mu dmu.
[[nodiscard]] LedBands averageFresnel(const SurfaceFresnel<double>& fresnel);

template <class P>
struct GgxMultiple {
    Ggx<P> single;
    MultipleScattering how;
    Bands<P> averageFresnel;
    std::shared_ptr<const AlbedoCurve> albedo;  // one curve serves the float and the double kernel

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        return single.template f<E>(pair) + bounced(pair);
    }

    [[nodiscard]] LobeMixture lobes() const {
        return {{albedo->average().e, GgxLobe{single.alpha}},
                {albedo->average().oneMinusE, CosineLobe{}}};
    }

private:
    template <class D>
    [[nodiscard]] Bands<P> bounced(const Pair<D>& pair) const {
        const auto muOut = static_cast<double>(pair.out.z);
        if (how == MultipleScattering::FdezAguera) {
            const DirectionalAlbedo at = albedo->at(muOut);
            return single.fresnel.f0.each(
                [&](const P& f0) { return P(fdezAguera(f0, at) * P(1 / kPi)); });
        }
        const AverageAlbedo& average = albedo->average();
        const double lost = albedo->oneMinusE(static_cast<double>(pair.in.z)) *
                            albedo->oneMinusE(muOut) / (kPi * average.oneMinusE);
        return averageFresnel.each(
            [&](const P& one) { return P(bouncedFresnel(one, average) * P(lost)); });
    }
};

}  // namespace gonio::proc
