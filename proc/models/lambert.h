#pragma once
// The Lambertian reflector: f = albedo / pi, for every pair of directions. Reciprocal; its
// directional albedo is `albedo`, in [0, 1], at every incidence. [Lambert1760]

#include "proc/models/kernel.h"

namespace gonio::proc {

template <class P>
struct Lambert {
    Bands<P> albedo;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>&) const {
        return albedo * P(1 / kPi);
    }
};

}  // namespace gonio::proc
