#pragma once
// The Lambertian reflector: f = albedo / pi, for every pair of directions. Reciprocal; its
// directional albedo is `albedo`, in [0, 1], at every incidence. [Lambert1760]

#include "proc/models/analytic.h"

namespace gonio::proc {

class Lambert : public AnalyticModel {
public:
    explicit Lambert(LedBands albedo) : albedo_(albedo) {}

protected:
    [[nodiscard]] LedBands evaluate(const LightView& pair) const override;

private:
    LedBands albedo_;
};

}  // namespace gonio::proc
