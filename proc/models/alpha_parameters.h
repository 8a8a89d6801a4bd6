#pragma once
// Width and Fresnel term of a microfacet lobe as a spec gives them.

#include "proc/models/catalogue.h"
#include "proc/models/surface_fresnel.h"

namespace gonio::proc {

struct AlphaNumbers {
    double x;
    double y;
};
/// alpha, or alpha_x and alpha_y.
[[nodiscard]] AlphaNumbers slopeAlphaOf(SpecParameters& p);
/// The same, or roughness: alpha = roughness^2.
[[nodiscard]] AlphaNumbers alphaOf(SpecParameters& p);

struct FresnelNumbers {
    FresnelForm form = FresnelForm::Schlick;
    LedBands f0;
    LedBands eta;
    LedBands k;

    template <class P>
    [[nodiscard]] SurfaceFresnel<P> as() const {
        return {
            .form = form, .f0 = Bands<P>::of(f0), .eta = Bands<P>::of(eta), .k = Bands<P>::of(k)};
    }
};
/// f0, or eta with or without k, or nk=FILE (optical_constants.h); fresnel=schlick|exact.
[[nodiscard]] FresnelNumbers fresnelOf(SpecParameters& p);

}  // namespace gonio::proc
