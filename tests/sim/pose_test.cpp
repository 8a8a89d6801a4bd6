#include "sim/pose.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gonio::sim {
namespace {

TEST(Pose, AMirrorsWedgeTurnsTheImageByTwiceItsAngle) {
    const Direction light = ledDirection(3);
    EXPECT_NEAR(angleBetween({mirrored(light, {}), mirrorOf(light)}).value(), 0, 1e-15);
    const Direction toward = mirrored(light, {0_deg, 7_deg});
    EXPECT_NEAR(toward.theta().degrees(), 46, 1e-12);
    EXPECT_NEAR(toward.phi().degrees(), 180, 1e-12);
    EXPECT_NEAR(mirrored(Direction(), {7_deg, 0_deg}).phi().degrees(), 270, 1e-12);
}

TEST(Pose, FlatGivesTheVerySameDirections) {
    const Direction d = Direction::fromSpherical(33_deg, 100_deg);
    EXPECT_EQ(Pose().seenFromSurface(d).vector(), d.vector());
    EXPECT_EQ(Pose({}, {}).seenFromSurface(d).vector(), d.vector());
}

TEST(Pose, TheSurfaceSeesAMirroredPairInItsOwnMirrorDirection) {
    for (const Wedge& wedge : {Wedge{2_deg, 0_deg}, Wedge{0_deg, -3_deg}, Wedge{1_deg, 4_deg}}) {
        const Pose pose(wedge, {});
        for (int led = 0; led < kLeds; ++led) {
            const Direction in = pose.seenFromSurface(ledDirection(led));
            const Direction out = pose.seenFromSurface(mirrored(ledDirection(led), wedge));
            EXPECT_NEAR(angleBetween({mirrorOf(in), out}).value(), 0, 1e-14) << led;
        }
    }
}

TEST(Pose, ASpotsWedgeAddsToTheSurfaces) {
    // About one axis angles add up exactly.
    const Pose both({0_deg, 2_deg}, {0_deg, 3_deg});
    const Pose one({0_deg, 5_deg}, {});
    const Direction d = Direction::fromSpherical(40_deg, 70_deg);
    EXPECT_NEAR(angleBetween({both.seenFromSurface(d), one.seenFromSurface(d)}).value(), 0, 1e-15);
}

/// Turned by +r under a fixed light, the surface sees the light at azimuth -r.
TEST(Pose, ATurnedSurfaceSeesTheLightTurnedBack) {
    const Pose pose({}, {}, 30_deg);
    const Direction light = pose.seenFromSurface(Direction::fromSpherical(40_deg, Radians(0)));
    EXPECT_NEAR(light.theta().degrees(), 40, 1e-12);
    EXPECT_NEAR(light.phi().degrees(), 330, 1e-12);
    // The stage tilts with what lies on it: the normal is the wedge's, however it is turned.
    const Direction normal = Pose({.aboutX = 5_deg}, {}, 70_deg)
                                 .seenFromSurface(Direction::fromSpherical(5_deg, -90_deg));
    EXPECT_NEAR(normal.theta().degrees(), 0, 1e-6);
}

TEST(Pose, WavesHaveMeanZeroAndTheirSizeAsRootMeanSquare) {
    for (std::uint64_t seed = 1; seed < 20; ++seed) {
        double x = 0, y = 0, squares = 0;
        for (const Wedge& spot : waves(seed, 2_deg)) {
            x += spot.aboutX.degrees();
            y += spot.aboutY.degrees();
            squares += std::pow(spot.aboutX.degrees(), 2) + std::pow(spot.aboutY.degrees(), 2);
        }
        EXPECT_NEAR(x, 0, 1e-12);
        EXPECT_NEAR(y, 0, 1e-12);
        EXPECT_NEAR(std::sqrt(squares / kLeds), 2, 1e-12);
    }
    EXPECT_NE(waves(1, 2_deg)[0].aboutX, waves(2, 2_deg)[0].aboutX);
    for (const Wedge& spot : waves(1, 0_deg)) EXPECT_TRUE(spot.flat());
}

TEST(Pose, AWedgeIsAlwaysOffByTheSame) {
    double squares = 0;
    constexpr int kWedges = 500;
    for (int i = 0; i < kWedges; ++i) {
        const Wedge nominal{Radians::fromDegrees(0.1 * i), 0_deg};
        const Wedge there = asGround(nominal, 3, 0.01_deg);
        const Wedge again = asGround(nominal, 3, 0.01_deg);
        EXPECT_EQ(there.aboutX, again.aboutX);
        EXPECT_EQ(there.aboutY, again.aboutY);
        EXPECT_NE(there.aboutY, asGround(nominal, 4, 0.01_deg).aboutY);
        squares += std::pow((there.aboutX - nominal.aboutX).degrees(), 2) +
                   std::pow(there.aboutY.degrees(), 2);
    }
    EXPECT_NEAR(std::sqrt(squares / (2 * kWedges)), 0.01, 0.001);
    EXPECT_EQ(asGround({7_deg, 0_deg}, 3, 0_deg).aboutX, 7_deg);
}

}  // namespace
}  // namespace gonio::sim
