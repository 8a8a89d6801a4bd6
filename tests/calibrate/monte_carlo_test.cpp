#include "proc/calibrate/monte_carlo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "proc/core/units.h"

namespace gonio::proc {
namespace {

constexpr int kDraws = 20'000;
// The 95 % quantile of 20 000 absolute deviations of a Gaussian scatters by
// sqrt(0.05 0.95 / 20 000) / 0.117 / 1.96 = 0.7 % of itself: 4.5 of these.
constexpr double kScatter = 0.03;

/// A sample as bright as a third of white, black a thousandth of it.
CellInputs bright() {
    return {.sample = 3.4e5,
            .white = 1e6,
            .black = 2e3,
            .sampleVariance = 1e6,
            .whiteVariance = 1e6,
            .blackVariance = 1e4,
            .fWhite = 0.31,
            .fBlack = 3e-4,
            .uWhite = 0.005,
            .uBlack = 3e-5,
            .uLight = 0.002,
            .uAngle = DirectionSpread::even(Radians(1e-4)),
            .uElse = 2e-4,
            .shape = {.logarithmic = false, .theta = {.slope = 3, .curvature = 0}, .phi = {}}};
}

TEST(MonteCarlo, AgreesWithFirstOrderWhereTheEquationIsLinear) {
    const CellInputs in = bright();
    const double contrast = in.white - in.black;
    const double gain = (in.fWhite - in.fBlack) / contrast;
    const double q = (in.sample - in.black) / contrast;
    const double random = gain * std::sqrt(in.sampleVariance + q * q * in.whiteVariance +
                                           (1 - q) * (1 - q) * in.blackVariance);
    double systematic = 0;
    for (const double part : {q * in.fWhite * in.uWhite,
                              (1 - q) * in.uBlack,
                              in.uLight * gain * in.sample,
                              in.uLight * gain * q * in.white,
                              in.uLight * gain * (1 - q) * in.black,
                              3 * in.uAngle.alongTheta.value(),
                              in.uElse}) {
        systematic = std::hypot(systematic, part);
    }
    const PropagatedUncertainty u = propagate(in, kDraws, 5);
    EXPECT_NEAR(u.random / random, 1, kScatter);
    EXPECT_NEAR(std::hypot(u.random, u.systematic) / std::hypot(random, systematic), 1, kScatter);
    EXPECT_FALSE(firstOrderFails(in, std::hypot(random, systematic)));
}

/// The half width that holds 95 %, over 1.96, of what `held(h)` gives the share within h for.
double expectedU(const std::function<double(double)>& held) {
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (held(middle) < 0.95 ? low : high) = middle;
    }
    return high / 1.96;
}

double normalShare(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

TEST(MonteCarlo, OnASteepFlankItIsTheLognormalsAndNotFirstOrder) {
    // 2 per degree, 0.2 degree: ln f is off by 0.4 sigma.
    CellInputs in{.sample = 1, .white = 2, .fWhite = 1, .shape = {}};
    in.uAngle = DirectionSpread::even(0.2_deg);
    in.shape.logarithmic = true;
    in.shape.theta.slope = 2 * 180 / kPi;
    const double wanted = expectedU([](double h) {
        return normalShare(std::log1p(h) / 0.4) - normalShare(std::log1p(-h) / 0.4);
    });
    const double first = 0.4;
    EXPECT_GT(wanted / first, 1.05);
    const PropagatedUncertainty u = propagate(in, kDraws, 5);
    EXPECT_EQ(u.random, 0);
    EXPECT_NEAR(u.systematic / in.f() / wanted, 1, kScatter);
    EXPECT_TRUE(firstOrderFails(in, first * in.f()));
}

TEST(MonteCarlo, OfAContrastOfFiveSigmasItIsTheQuotients) {
    const CellInputs in{.sample = 1, .white = 1, .whiteVariance = 0.04, .fWhite = 0.3, .shape = {}};
    const double wanted = expectedU([](double h) {
        return normalShare((1 / (1 - h) - 1) / 0.2) - normalShare((1 / (1 + h) - 1) / 0.2);
    });
    EXPECT_GT(wanted / 0.2, 1.2);
    const PropagatedUncertainty u = propagate(in, kDraws, 5);
    EXPECT_NEAR(u.random / in.f() / wanted, 1, kScatter);
    EXPECT_TRUE(firstOrderFails(in, 0.2 * in.f()));
}

TEST(MonteCarlo, TheSameSeedGivesTheSameResult) {
    const PropagatedUncertainty once = propagate(bright(), 100, 7),
                                again = propagate(bright(), 100, 7);
    EXPECT_EQ(once.random, again.random);
    EXPECT_EQ(once.systematic, again.systematic);
    EXPECT_NE(once.random, propagate(bright(), 100, 8).random);
}

TEST(MonteCarlo, FirstOrderFailsWhereTheContrastIsNotKnownToATenth) {
    CellInputs in = bright();
    const double contrast = in.white - in.black;
    in.uLight = 0;
    in.whiteVariance = std::pow(0.099 * contrast, 2);
    EXPECT_FALSE(firstOrderFails(in, 1));
    in.whiteVariance = std::pow(0.101 * contrast, 2);
    EXPECT_TRUE(firstOrderFails(in, 1));
}

TEST(MonteCarlo, FirstOrderFailsWhereCurvatureIsATenthOfU) {
    CellInputs in = bright();
    in.shape.theta.curvature = 1e4;
    const double u = in.uAngle.alongTheta.value();
    const double second = std::sqrt(0.75) * 1e4 * u * u;
    EXPECT_FALSE(firstOrderFails(in, 10.1 * second));
    EXPECT_TRUE(firstOrderFails(in, 9.9 * second));
}

}  // namespace
}  // namespace gonio::proc
