#include "sim/light.h"

#include <gtest/gtest.h>

namespace gonio::sim {
namespace {

TEST(Light, LedsStandAtTheirAnglesOnTheSideOfPhiZero) {
    for (int led = 0; led < kLeds; ++led) {
        const Direction wi = ledDirection(led);
        EXPECT_NEAR(wi.theta().degrees(), 20 * led, 1e-12);
        EXPECT_NEAR(wi.y(), 0, 1e-16);
        EXPECT_GE(wi.x(), 0);
    }
}

TEST(Light, RatesAreThoseOfThePhotonBudget) {
    EXPECT_DOUBLE_EQ(ledRate(0, Band::G), 4.5e7);
    for (int led = 0; led < kLeds; ++led) {
        for (Band band : kBands) {
            EXPECT_GT(ledRate(led, band), 1e7);
            EXPECT_LE(ledRate(led, band), ledRate(0, Band::G));
            // Band and LED are independent factors.
            EXPECT_DOUBLE_EQ(ledRate(led, band) * ledRate(0, Band::G),
                             ledRate(led, Band::G) * ledRate(0, band));
        }
    }
}

TEST(Light, StrayLightIsWeakPositiveAndSmooth) {
    for (int led = 0; led < kLeds; ++led) {
        for (double theta = 0; theta <= 76; theta += 4) {
            for (double phi = 0; phi < 360; phi += 30) {
                const Direction wo = Direction::fromSpherical(Radians::fromDegrees(theta),
                                                              Radians::fromDegrees(phi));
                const double stray = strayLight(led, wo);
                EXPECT_NEAR(stray, 3e-4, 2e-4);
                const Direction beside = Direction::fromSpherical(Radians::fromDegrees(theta + 0.1),
                                                                  Radians::fromDegrees(phi));
                // Its slope is below 3e-4 x (0.3 + 2 x 0.2) per radian.
                EXPECT_LE(std::abs(strayLight(led, beside) - stray), 2.1e-4 * 0.1 * kPi / 180);
            }
        }
    }
}

}  // namespace
}  // namespace gonio::sim
