#pragma once
// Disney's diffuse reflection [Burley2012, sec. 5.3]: f = albedo / pi times Burley's factor with
// F90 = 0.5 + 2 roughness cos^2(theta_d). roughness is the perceptual one, in [0, 1] (printed
// elsewhere with alpha in its place). Reciprocal. Not energy conserving: directional albedo for
// albedo 1 is 0.54..1.558, the most at grazing, roughness 1.

#include "proc/models/burley_diffuse.h"

namespace gonio::proc {

template <class P>
struct DisneyDiffuse {
    Bands<P> albedo;
    P roughness;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const D cosDiff = Half<D>(pair).cosDiff;
        const P f90 = P(0.5) + P(2) * roughness * (cosDiff * cosDiff);
        return albedo * P(burleyFactor(f90, pair) * P(1 / kPi));
    }
};

}  // namespace gonio::proc
