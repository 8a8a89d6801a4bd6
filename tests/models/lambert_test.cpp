#include "proc/models/lambert.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/models/spec.h"

namespace gonio::proc {
namespace {

const LedBands kAlbedo{{0.9, 0.5, 0}};

std::unique_ptr<const AnalyticModel> lambert() {
    return std::move(*makeModel("lambert,albedo=0.9/0.5/0"));
}

TEST(LambertModel, IsAlbedoOverPiForEveryPair) {
    const auto model = lambert();
    for (double thetaIn : {0.0, 40.0, 89.999}) {
        for (double thetaOut : {0.0, 40.0, 89.999}) {
            for (double phi : {0.0, 123.0}) {
                const Answer answer =
                    model->answer({Direction::fromSpherical(Radians::fromDegrees(thetaIn), 0_deg),
                                   Direction::fromSpherical(Radians::fromDegrees(thetaOut),
                                                            Radians::fromDegrees(phi))});
                for (Band b : kBands) EXPECT_DOUBLE_EQ(answer.f[b], kAlbedo[b] / kPi);
            }
        }
    }
}

TEST(LambertModel, ScattersItsAlbedo) {
    // Midpoint rule over s = sin^2(theta), in which cos(theta) dOmega = pi ds: exact for a
    // constant.
    const auto model = lambert();
    double albedo = 0;
    constexpr int kRings = 50;
    for (int i = 0; i < kRings; ++i) {
        const Radians theta(std::asin(std::sqrt((i + 0.5) / kRings)));
        albedo += model->answer({Direction(), Direction::fromSpherical(theta, 0_deg)}).f[Band::R] *
                  kPi / kRings;
    }
    EXPECT_NEAR(albedo, 0.9, 1e-14);
}

TEST(AnalyticModel, AnswersWithItsSourceAndWithoutUncertainty) {
    const Answer answer = lambert()->answer({Direction(), Direction()});
    EXPECT_EQ(answer.source, Source::Analytic);
    EXPECT_EQ(answer.flags, Flags{});
    EXPECT_FALSE(answer.uRandom || answer.uSystematic);
    const Answer below = lambert()->answer({Direction(), *Direction::fromVector({1, 0, 0})});
    EXPECT_EQ(below.source, Source::Analytic);
    EXPECT_EQ(below.flags, Flags{Flag::BelowHorizon});
    EXPECT_TRUE(std::isnan(below.f[Band::B]));  // albedo 0: missing is not 0
}

}  // namespace
}  // namespace gonio::proc
