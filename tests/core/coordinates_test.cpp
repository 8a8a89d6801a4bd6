#include "proc/core/coordinates.h"

#include <gtest/gtest.h>

#include <random>

namespace gonio {
namespace {

constexpr double kRoundTrip = 1e-12;

/// Directions all over the sphere's upper half, poles and grazing included.
std::vector<Direction> directions() {
    std::vector<Direction> all;
    for (double theta : {0.0, 1e-12, 1e-9, 1e-5, 0.3, 1.0, kPi / 2 - 1e-5, kPi / 2 - 1e-9}) {
        for (double phi : {0.0, 1e-9, 1.0, kPi / 2, kPi - 1e-9, kPi, 4.0, 2 * kPi - 1e-9}) {
            all.push_back(Direction::fromSpherical(Radians(theta), Radians(phi)));
        }
    }
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 150; ++i) {
        all.push_back(Direction::fromSpherical(Radians(std::acos(unit(random))),
                                               Radians(2 * kPi * unit(random))));
    }
    return all;
}

TEST(SpecularRelative, RoundTripsEverywhere) {
    for (const Direction& wi : directions()) {
        for (const Direction& wo : directions()) {
            const SpecularRelative at = toSpecularRelative({wi, wo}, wi.phi());
            const Direction back = fromSpecularRelative(wi, at, wi.phi());
            EXPECT_LE(angleBetween({wo, back}).value(), kRoundTrip);
        }
    }
}

TEST(SpecularRelative, ReadsAsInZemaxFiles) {
    const Direction wi = Direction::fromSpherical(30_deg, 0_deg);
    // Azimuth 0 points from the specular direction toward the normal.
    const SpecularRelative normal = toSpecularRelative({wi, Direction()});
    EXPECT_NEAR(normal.radial.degrees(), 30, 1e-12);
    EXPECT_NEAR(normal.azimuth.degrees(), 0, 1e-12);
    // With the light on +x, azimuth 90 is +y.
    const Direction side = fromSpecularRelative(wi, {10_deg, 90_deg});
    EXPECT_GT(side.y(), 0.1);
}

TEST(SpecularRelative, TakesTheLightsSideAtNormalIncidence) {
    const Direction wo = Direction::fromSpherical(20_deg, 70_deg);
    EXPECT_NEAR(toSpecularRelative({Direction(), wo}, 0_deg).azimuth.degrees(), 70, 1e-12);
    EXPECT_NEAR(toSpecularRelative({Direction(), wo}, 30_deg).azimuth.degrees(), 40, 1e-12);
}

TEST(SpecularRelative, KeepsTheDigitsOfSmallRadialAngles) {
    const Direction wi = Direction::fromSpherical(40_deg, 0_deg);
    const Direction wo = fromSpecularRelative(wi, {Radians(1e-7), 33_deg});
    const SpecularRelative at = toSpecularRelative({wi, wo});
    EXPECT_NEAR(at.radial.value(), 1e-7, 1e-15);
    EXPECT_NEAR(at.azimuth.degrees(), 33, 1e-6);
}

TEST(HalfDifference, RoundTripsEverywhere) {
    for (const Direction& wi : directions()) {
        for (const Direction& wo : directions()) {
            const auto at = toHalfDifference({wi, wo});
            ASSERT_TRUE(at);
            const LightView back = fromHalfDifference(*at);
            // Opposite grazing directions have a half vector of length ~theta: its own rounding.
            const double length = (wi.vector() + wo.vector()).norm();
            const double tolerance = std::max(kRoundTrip, 1e-15 / length);
            EXPECT_LE(angleBetween({wi, back.in}).value(), tolerance);
            EXPECT_LE(angleBetween({wo, back.out}).value(), tolerance);
        }
    }
}

TEST(HalfDifference, HasNoHalfVectorForOppositeDirections) {
    const Direction wi = Direction::fromSpherical(30_deg, 0_deg);
    EXPECT_FALSE(toHalfDifference({wi, *Direction::fromVector(-wi.vector())}));
}

TEST(HalfDifference, IsZeroDifferenceInRetroReflection) {
    const Direction wi = Direction::fromSpherical(50_deg, 20_deg);
    const auto at = toHalfDifference({wi, wi});
    ASSERT_TRUE(at);
    EXPECT_EQ(at->thetaDiff.value(), 0);
    EXPECT_EQ(at->phiDiff.value(), 0);
    EXPECT_NEAR(at->thetaHalf.degrees(), 50, 1e-12);
}

}  // namespace
}  // namespace gonio
