#include "proc/core/direction.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace gonio {
namespace {

// Angles come from atan2 of sines and cosines with one rounding each: a few ulp of pi.
constexpr double kTolerance = 1e-14;

TEST(Direction, RoundTripsSphericalEverywhere) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> polar(0, kPi);
    std::uniform_real_distribution<double> azimuth(0, 2 * kPi);
    for (int i = 0; i < 100000; ++i) {
        const Radians theta(polar(random));
        const Radians phi(azimuth(random));
        const Direction d = Direction::fromSpherical(theta, phi);
        EXPECT_NEAR(d.theta().value(), theta.value(), kTolerance);
        const double turn = std::remainder(d.phi().value() - phi.value(), 2 * kPi);
        EXPECT_LE(std::abs(turn) * sin(theta), kTolerance);
        EXPECT_NEAR(d.vector().norm(), 1, 4 * std::numeric_limits<double>::epsilon());
    }
}

TEST(Direction, KeepsSmallPolarAngles) {
    for (double theta : {0.0, 1e-300, 1e-15, 1e-9, 1e-4}) {
        EXPECT_DOUBLE_EQ(Direction::fromSpherical(Radians(theta), Radians(1)).theta().value(),
                         theta);
    }
}

TEST(Direction, KeepsGrazingAngles) {
    const Direction d = Direction::fromSpherical(Radians(kPi / 2 - 1e-9), Radians(0));
    EXPECT_NEAR(d.z(), 1e-9, 3e-16);  // the rounding of pi/2 - 1e-9
    EXPECT_TRUE(d.aboveHorizon());
}

TEST(Direction, NormalisesAnyLength) {
    for (double scale : {1e-300, 1e-9, 1.0, 1e9, 1e300}) {
        const auto d = Direction::fromVector({3 * scale, 0, 4 * scale});
        ASSERT_TRUE(d);
        EXPECT_DOUBLE_EQ(d->x(), 0.6);
        EXPECT_DOUBLE_EQ(d->z(), 0.8);
    }
}

TEST(Direction, RefusesVectorsWithoutDirection) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(Direction::fromVector({0, 0, 0}));
    EXPECT_FALSE(Direction::fromVector({nan, 0, 1}));
    EXPECT_FALSE(Direction::fromVector({inf, 0, 1}));
    EXPECT_FALSE(Direction::fromVector({1e-310, 0, 0}));
}

TEST(Direction, TurnsCounterClockwiseSeenFromAbove) {
    const Direction x = Direction::fromSpherical(90_deg, 0_deg);
    EXPECT_NEAR(x.turned(90_deg).y(), 1, 1e-15);
}

TEST(Direction, AngleBetweenIsExactAtItsEnds) {
    const Direction n;
    EXPECT_EQ(angleBetween({n, n}).value(), 0);
    EXPECT_DOUBLE_EQ(
        angleBetween({n, Direction::fromSpherical(Radians(1e-12), Radians(2))}).value(), 1e-12);
    EXPECT_DOUBLE_EQ(angleBetween({n, *Direction::fromVector({0, 0, -1})}).value(), kPi);
}

TEST(Direction, MirrorIsAnInvolution) {
    const Direction wi = Direction::fromSpherical(40_deg, 0_deg);
    EXPECT_NEAR(mirrorOf(wi).phi().degrees(), 180, 1e-12);
    EXPECT_NEAR(angleBetween({mirrorOf(mirrorOf(wi)), wi}).value(), 0, 1e-15);
}

}  // namespace
}  // namespace gonio
