#include "proc/optics/lens_map.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/optics/lenses.h"

namespace gonio::proc {
namespace {

TEST(LensMap, DirectionsComeBackFromTheSensor) {
    const LensMap map = test::crookedLens();
    for (double theta = 0; theta <= 85; theta += 2.5) {
        for (double phi = 0; phi < 360; phi += 7.5) {
            const Direction wo =
                Direction::fromSpherical(Radians::fromDegrees(theta), Radians::fromDegrees(phi));
            const auto back = map.directionAt(map.pointOf(wo));
            ASSERT_TRUE(back);
            ASSERT_LT(angleBetween({wo, *back}).value(), 1e-12) << theta << " " << phi;
        }
    }
}

TEST(LensMap, ImageXIsSampleXAndImageDownIsMinusY) {
    const LensMap map = LensMap::fTheta({640, 512}, 6.6);
    const SensorPoint middle = map.pointOf(Direction());
    EXPECT_NEAR(middle.x, 640, 1e-12);
    EXPECT_NEAR(middle.y, 512, 1e-12);
    const SensorPoint x = map.pointOf(Direction::fromSpherical(10_deg, 0_deg));
    EXPECT_NEAR(x.x, 706, 1e-9);
    EXPECT_NEAR(x.y, 512, 1e-9);
    const SensorPoint y = map.pointOf(Direction::fromSpherical(10_deg, 90_deg));
    EXPECT_NEAR(y.x, 640, 1e-9);
    EXPECT_NEAR(y.y, 446, 1e-9);
}

TEST(LensMap, SolidAngleIsTheJacobian) {
    const LensMap map = test::crookedLens();
    for (const SensorPoint at :
         {SensorPoint{645.31, 506.81}, {700, 300}, {1100, 500}, {300, 800}}) {
        // The triangle of three near directions, doubled.
        const double h = 0.05;
        const Eigen::Vector3d o = map.directionAt(at)->vector();
        const Eigen::Vector3d x = map.directionAt({at.x + h, at.y})->vector() - o;
        const Eigen::Vector3d y = map.directionAt({at.x, at.y + h})->vector() - o;
        const double numeric = x.cross(y).norm() / (h * h);
        EXPECT_NEAR(map.solidAnglePerPixel(at) / numeric, 1, 1e-3) << at.x << " " << at.y;
    }
}

TEST(LensMap, SolidAnglesAddUpToTheCap) {
    const LensMap map = test::crookedLens();
    double sum = 0;
    for (int y = 0; y < 1100; ++y) {
        for (int x = 60; x < 1240; ++x) {
            const SensorPoint at{x + 0.5, y + 0.5};
            const auto wo = map.directionAt(at);
            if (wo && wo->theta() < 75_deg) sum += map.solidAnglePerPixel(at);
        }
    }
    EXPECT_NEAR(sum / (2 * kPi * (1 - cos(75_deg))), 1, 1e-4);
}

TEST(LensMap, KeepsItsParameters) {
    const LensMap map = test::crookedLens();
    EXPECT_EQ(LensMap::fromValues(map.values()).parameters(), map.parameters());
}

TEST(LensMap, EndsWhereThePolynomialTurnsBack) {
    // theta = 1.2 r - 0.4 r^3 peaks at r = 1 with 0.8 rad = 45.8 degrees.
    const LensMap map({.centreX = 640, .centreY = 512, .c1 = 1.2, .c3 = -0.4});
    EXPECT_NEAR(map.maxTheta().value(), 0.8, 1e-3);
    EXPECT_TRUE(map.directionAt({640 + 480, 512}));
    EXPECT_FALSE(map.directionAt({640 + 510, 512}));
    EXPECT_FALSE(map.directionAt(map.pointOf(Direction::fromSpherical(60_deg, 30_deg))));
}

TEST(LensMap, AnswersNothingBelowTheHorizon) {
    const LensMap map = LensMap::fTheta({640, 512}, 6.6);
    EXPECT_NEAR(map.maxTheta().degrees(), 90, 1e-9);
    EXPECT_FALSE(map.directionAt({640 + 6.6 * 92, 512}));
}

}  // namespace
}  // namespace gonio::proc
