#pragma once
// Rough diffuse reflection of Lambertian V-cavities, the qualitative model [OrenNayar1994, eq. 30]:
//   f = albedo / pi (A + B max(0, cos(phi_i - phi_o)) sin(alpha) tan(beta)),
//   A = 1 - 0.5 s2 / (s2 + 0.33), B = 0.45 s2 / (s2 + 0.09), s2 = sigma^2, sigma in radians >= 0,
//   alpha = max(theta_i, theta_o), beta = min(theta_i, theta_o).
// The product of sine and tangent is computed as (xi xo + yi yo) / max(mu_i, mu_o): no acos, no 0/0
// at the pole. Reciprocal. Directional albedo for albedo 1 is 0.62..1.015 (the most near grazing at
// sigma 0.2): the model itself is not strictly energy conserving. At sigma = 0: Lambert.

#include "proc/models/kernel.h"

namespace gonio::proc {

template <class P>
struct OrenNayar {
    Bands<P> albedo;
    P sigma;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const P s2 = sigma * sigma;
        const P a = P(1) - P(0.5) * s2 / (s2 + P(0.33));
        const P b = P(0.45) * s2 / (s2 + P(0.09));
        const D across = pair.in.x * pair.out.x + pair.in.y * pair.out.y;
        const D sinTan = std::max(D(0), across) / std::max(pair.in.z, pair.out.z);
        return albedo * P((a + b * sinTan) * P(1 / kPi));
    }
};

}  // namespace gonio::proc
