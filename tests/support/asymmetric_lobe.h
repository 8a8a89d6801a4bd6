#pragma once
// A BRDF that tells left from right: a lobe about a direction off the plane of incidence. What a
// format mirrors by mistake moves it to the other side. It turns with the light.

#include <cmath>

#include "proc/core/scatterer.h"

namespace gonio::test {

class AsymmetricLobe : public Scatterer {
public:
    explicit AsymmetricLobe(double sharpness = 20) : sharpness_(sharpness) {}

    [[nodiscard]] Answer answer(const LightView& pair) const override {
        if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
            return Answer::none({Flag::BelowHorizon}, Source::Analytic);
        }
        const Direction lobe = lobeOf(pair.in);
        const double cosine = pair.out.vector().dot(lobe.vector());
        Answer answer;
        answer.f = LedBands{{0.2, 0.1, 0.05}} * (1 + std::exp(sharpness_ * (cosine - 1)));
        return answer;
    }

    /// 40 degrees counter-clockwise of the mirror direction, at 45 degrees.
    [[nodiscard]] static Direction lobeOf(const Direction& wi) {
        return Direction::fromSpherical(45_deg, wi.phi() + 220_deg);
    }

private:
    double sharpness_;
};

}  // namespace gonio::test
