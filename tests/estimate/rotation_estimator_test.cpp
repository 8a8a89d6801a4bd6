#include "proc/estimate/rotation_estimator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/estimate/scatterers.h"

namespace gonio::proc {
namespace {

constexpr double kU = 0.01;

/// Of a grain along x, as the light's and the view's azimuth feel it.
double grain(const LightView& pair) {
    return 1 + 0.3 * std::cos(2 * pair.in.phi().value()) + 0.1 * pair.out.x();
}

/// What the rig sees of it at a rotation; known to 1 %, each rotation by itself.
Result<std::shared_ptr<const Scatterer>> seenAt(Radians rotation) {
    return std::shared_ptr<const Scatterer>(
        std::make_shared<test::Made>([rotation](const LightView& inRig) {
            const LightView pair{
                .in = Direction::fromSpherical(inRig.in.theta(), inRig.in.phi() - rotation),
                .out = inRig.out.turned(-rotation)};
            Answer answer = test::answerOf(grain(pair));
            answer.uRandom = LedBands::all(kU);
            answer.uSystematic = LedBands::all(kU);
            answer.source = Source::Measured;
            answer.flags.set(Flag::Measured);
            return answer;
        }));
}

LightView pairAt(Radians phi) {
    return {.in = Direction::fromSpherical(40_deg, phi),
            .out = Direction::fromSpherical(30_deg, phi + 100_deg)};
}

TEST(RotationEstimator, AnswersAtBetweenAndBeyondTheRotations) {
    const auto made = RotationEstimator::over({0_deg, 45_deg, 90_deg}, seenAt);
    ASSERT_TRUE(made);
    const Answer at = (*made)->answer(pairAt(-45_deg));
    EXPECT_NEAR(at.f[Band::R], grain(pairAt(-45_deg)), 1e-12);
    EXPECT_EQ(at.source, Source::Measured);

    for (const Radians phi : {-10_deg, -22.5_deg, -80_deg}) {
        const Answer between = (*made)->answer(pairAt(phi));
        EXPECT_EQ(between.source, Source::Interpolated);
        EXPECT_FALSE(between.flags.has(Flag::Measured));
        // The grain's wave of half a turn is off by less than twice what is said of it.
        EXPECT_LE(std::abs(between.f[Band::G] - grain(pairAt(phi))), 2 * *between.u(Band::G));
        EXPECT_LT((*between.uRandom)[Band::G], kU);
        EXPECT_GT((*between.uSystematic)[Band::G], kU);
    }

    const Answer beyond = (*made)->answer(pairAt(30_deg));
    EXPECT_EQ(beyond.source, Source::Extrapolated);
    EXPECT_TRUE(beyond.flags.has(Flag::Extrapolated));
    EXPECT_LE(std::abs(beyond.f[Band::B] - grain(pairAt(30_deg))), 2 * *beyond.u(Band::B));

    const LightView normal{.in = {}, .out = Direction::fromSpherical(30_deg, 200_deg)};
    EXPECT_NEAR((*made)->answer(normal).f[Band::R], grain(normal), 1e-12);
    EXPECT_FALSE((*made)->answer({Direction::fromSpherical(91_deg, 0_deg), {}}).present());

    const auto none = RotationEstimator::over(
        {0_deg, 90_deg}, [](Radians) -> Result<std::shared_ptr<const Scatterer>> {
            return Error{ErrorKind::Quality, "nothing in it"};
        });
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().message, "nothing in it");
}

}  // namespace
}  // namespace gonio::proc
