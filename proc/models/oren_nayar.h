#pragma once
// Rough diffuse reflection of Lambertian V-cavities, the qualitative model [OrenNayar1994, eq. 30]:
//   f = albedo / pi (A + B max(0, cos(phi_i - phi_o)) sin(alpha) tan(beta)),
//   A = 1 - 0.5 s2 / (s2 + 0.33), B = 0.45 s2 / (s2 + 0.09), s2 = sigma^2, sigma in radians >= 0,
//   alpha = max(theta_i, theta_o), beta = min(theta_i, theta_o).
// The product of sine and tangent is computed as (xi xo + yi yo) / max(mu_i, mu_o): no acos, no 0/0
// at the pole. Reciprocal. Directional albedo for albedo 1 reaches 1.015 near grazing (sigma 0.2):
// the model itself is not strictly energy conserving. At sigma = 0: Lambert.

#include "proc/models/analytic.h"

namespace gonio::proc {

class OrenNayar : public AnalyticModel {
public:
    OrenNayar(LedBands albedo, Radians sigma);

protected:
    [[nodiscard]] LedBands evaluate(const LightView& pair) const override;

private:
    LedBands albedo_;
    double a_;
    double b_;
};

}  // namespace gonio::proc
