#pragma once
// Disney's diffuse with its energy brought down [Lagarde2014, listing 1]:
//   f = albedo / pi (1 + r (1/1.51 - 1)) times Burley's factor with F90 = r (0.5 + 2
//   cos^2(theta_d)),
// r the perceptual roughness in [0, 1]. Reciprocal. Directional albedo for albedo 1 is at
// most 1.032 (at grazing; 1.006 where mu >= 0.02).

#include "proc/models/burley_diffuse.h"

namespace gonio::proc {

template <class P>
struct FrostbiteDiffuse {
    Bands<P> albedo;
    P roughness;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const D cosDiff = Half<D>(pair).cosDiff;
        const P f90 = roughness * (D(0.5) + D(2) * cosDiff * cosDiff);
        const P energy = P(1) + roughness * P(1 / 1.51 - 1);
        return albedo * P(burleyFactor(f90, pair) * energy * P(1 / kPi));
    }
};

}  // namespace gonio::proc
