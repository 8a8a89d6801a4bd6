#include "proc/report/colour_ramp.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace gonio::proc {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// CIE L* of "#rrggbb" in sRGB, white = 100.
double lightness(const std::string& colour) {
    const std::array<double, 3> weight{0.2126, 0.7152, 0.0722};
    double y = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double v = std::stoi(colour.substr(1 + 2 * c, 2), nullptr, 16) / 255.0;
        y += weight[c] * (v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    }
    return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

TEST(RampColour, RunsFromDarkVioletToYellow) {
    EXPECT_EQ(rampColour(0), "#440154");
    EXPECT_EQ(rampColour(0.5), "#21908d");
    EXPECT_EQ(rampColour(1), "#fde725");
}

TEST(RampColour, IsClampedToItsEnds) {
    for (double t : {-1e-300, -1.0, -kInf, kNan}) EXPECT_EQ(rampColour(t), rampColour(0)) << t;
    for (double t : {1 + 1e-15, 2.0, kInf}) EXPECT_EQ(rampColour(t), rampColour(1)) << t;
}

TEST(RampColour, GrowsLighterWithEveryStep) {
    for (int i = 1; i <= 64; ++i) {
        EXPECT_GT(lightness(rampColour(i / 64.0)), lightness(rampColour((i - 1) / 64.0))) << i;
    }
}

TEST(RampColour, EqualStepsAreEquallyLight) {
    const double step = (lightness(rampColour(1)) - lightness(rampColour(0))) / 8;
    EXPECT_NEAR(lightness(rampColour(0)), 15, 1);
    EXPECT_NEAR(lightness(rampColour(1)), 91, 1);
    for (int i = 1; i <= 8; ++i) {
        const double seen = lightness(rampColour(i / 8.0)) - lightness(rampColour((i - 1) / 8.0));
        // Even in the eye's own unit to about a just noticeable difference (2.3 of L*).
        EXPECT_NEAR(seen, step, 2.3) << i;
    }
}

TEST(LogAxis, HoldsWhatItCoversInTheFewestDecades) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> exponent(-6, 2);
    for (int i = 0; i < 2000; ++i) {
        const double a = exponent(random);
        const double b = exponent(random);
        const double lowest = std::pow(10, std::min(a, b));
        const double highest = std::pow(10, std::max(a, b));
        const LogAxis axis = LogAxis::covering(lowest, highest);
        EXPECT_LE(axis.firstDecade, std::min(a, b));
        EXPECT_GE(axis.lastDecade, std::max(a, b));
        EXPECT_GT(axis.firstDecade + 1, std::min(a, b));
        EXPECT_LT(axis.lastDecade - 1, std::max(a, b));
        EXPECT_GT(axis.position(highest), axis.position(lowest));
    }
}

TEST(LogAxis, ExactDecadesAreItsEnds) {
    for (int first = -12; first < 8; ++first) {
        const LogAxis axis = LogAxis::covering(std::pow(10, first), std::pow(10, first + 3));
        EXPECT_EQ(axis.firstDecade, first);
        EXPECT_EQ(axis.lastDecade, first + 3);
    }
    // Rounding beside a decade opens no decade of its own: 1e-9 of an exponent is 2.3e-9.
    const LogAxis axis = LogAxis::covering(1e-3 * (1 - 1e-12), 1e-1 * (1 + 1e-12));
    EXPECT_EQ(axis.firstDecade, -3);
    EXPECT_EQ(axis.lastDecade, -1);
}

TEST(LogAxis, OneValueHasADecadeToStandIn) {
    for (double value : {0.5, 1.0, 10.0, 1e-5, 3e7, 5e-324}) {
        const LogAxis axis = LogAxis::covering(value, value);
        EXPECT_EQ(axis.lastDecade, axis.firstDecade + 1) << value;
        EXPECT_LE(axis.firstDecade, std::log10(value) + 1e-9);
        EXPECT_GE(axis.lastDecade, std::log10(value) - 1e-9);
    }
}

TEST(LogAxis, KeepsTheUpperEightDecades) {
    const LogAxis eight = LogAxis::covering(1e-6, 1e2);
    EXPECT_EQ(eight.firstDecade, -6);
    const LogAxis more = LogAxis::covering(1e-300, 1e2);
    EXPECT_EQ(more.firstDecade, -6);
    EXPECT_EQ(more.lastDecade, 2);
    EXPECT_EQ(more.position(1e-300), 0);
}

TEST(LogAxis, PositionIsTheExponentBetweenTheEnds) {
    const LogAxis axis{.firstDecade = -3, .lastDecade = 1};
    EXPECT_EQ(axis.position(1e-3), 0);
    EXPECT_EQ(axis.position(1e1), 1);
    for (int decade = -3; decade <= 1; ++decade) {
        // log10 is right to an ulp or two of 3.
        EXPECT_NEAR(axis.position(std::pow(10, decade)), (decade + 3) / 4.0, 1e-15);
    }
    EXPECT_NEAR(axis.position(2e-2) - axis.position(1e-2), std::log10(2) / 4, 1e-15);
}

TEST(LogAxis, PositionIsClamped) {
    const LogAxis axis{.firstDecade = -3, .lastDecade = 1};
    for (double below : {9.9e-4, 1e-300, 0.0, -1.0, -kInf, kNan})
        EXPECT_EQ(axis.position(below), 0);
    for (double above : {10.1, 1e300, kInf}) EXPECT_EQ(axis.position(above), 1);
}

}  // namespace
}  // namespace gonio::proc
