#include "proc/radiance/linearity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/radiance/frames.h"

namespace gonio::proc {
namespace {

constexpr double kBlack = 60;
constexpr double kFull = 3900;  // DN above black, about the largest of the sweep
constexpr double kRate = 4e5;   // DN per second

/// What a sensor of 0.3 % non-linearity reads above black where a proportional one reads `dn`.
double bent(double dn, double size = 0.003) {
    const double m = dn / kFull;
    return dn + kFull * size * 4 * m * (1 - m);
}

/// A sweep of constant light, each mean known to `u` DN.
std::vector<SweepPoint> sweep(
    double size, double u, std::mt19937_64& random, double offset = 0, int count = 16) {
    std::normal_distribution<double> noise(0, u);
    std::vector<SweepPoint> points;
    for (int i = 1; i <= count; ++i) {
        const double tau = kFull / kRate * i / count;
        points.push_back(
            {.tau = tau, .meanDn = bent(kRate * tau + offset, size) + noise(random), .u = u});
    }
    return points;
}

TEST(Linearity, WithoutCoefficientsItIsTheIdentity) {
    const Linearity none;
    EXPECT_TRUE(none.identity());
    for (const double dn : {0.0, 60.0, 1234.5, 4095.0, 65535.0}) EXPECT_EQ(none.corrected(dn), dn);
}

TEST(Linearity, CorrectsNothingAtBlackAndStopsAtTheEndOfItsRange) {
    const Linearity l{.blackDn = 60, .rangeDn = 3900, .coefficients = {-0.01, 0.02, 0.001}};
    EXPECT_EQ(l.corrected(60), 60);
    EXPECT_NEAR(l.correction(60 + 1950), 3900 * (-0.005 + 0.005 + 0.001 / 8), 1e-9);
    EXPECT_NEAR(l.correction(3960), 3900 * 0.011, 1e-9);
    EXPECT_EQ(l.correction(4095), l.correction(3960));
    EXPECT_NEAR(l.correction(50), 0.1, 1e-12);  // below: as just above it
    // Just below, at and above black: no kink.
    EXPECT_NEAR((l.correction(60.001) - l.correction(60)) / 0.001, -0.01, 1e-7);
    EXPECT_NEAR((l.correction(60) - l.correction(59.999)) / 0.001, -0.01, 1e-7);
}

TEST(Linearity, AThirdOfAPerCentIsMeasuredAndRemoved) {
    std::mt19937_64 random(61);
    const auto fit = fitLinearity(sweep(0.003, 0.2, random), kBlack);
    ASSERT_TRUE(fit) << fit.error().message;
    // A parabola of height 0.3 % in the middle is at most 0.2 % (its ends, 2/3 of it) from its best
    // line; 0.2 DN of 3900 are 0.005 %.
    EXPECT_NEAR(fit->inlPercent, 0.2, 0.02);
    EXPECT_LT(fit->chiSquare, 12 + 5 * std::sqrt(24.0));
    EXPECT_EQ(fit->freedom, 12U);
    // Corrected readings are proportional to the light: their ratio to it is one number.
    const double scale = (fit->linearity.corrected(kBlack + bent(2000)) - kBlack) / 2000;
    for (double dn = 200; dn < kFull; dn += 100) {
        const double corrected = fit->linearity.corrected(kBlack + bent(dn)) - kBlack;
        EXPECT_NEAR(corrected / (scale * dn), 1, 1e-4 + 0.4 / dn) << dn;
    }
    // And the gain is on average what it was.
    double sum = 0, squares = 0;
    for (double m = 0.005; m < 1; m += 0.01) {
        const double dn = m * fit->linearity.rangeDn;
        sum += dn * fit->linearity.correction(kBlack + dn);
        squares += dn * dn;
    }
    EXPECT_NEAR(sum / squares, 0, 1e-5);
}

TEST(Linearity, AProportionalSensorNeedsNoCorrection) {
    std::mt19937_64 random(62);
    const auto fit = fitLinearity(sweep(0, 0.2, random), kBlack);
    ASSERT_TRUE(fit);
    EXPECT_LT(fit->inlPercent, 0.02);
    for (double dn = 0; dn < kFull; dn += 50)
        EXPECT_LT(std::abs(fit->linearity.correction(kBlack + dn)), 1) << dn;
}

TEST(Linearity, AnOffsetIsNotTakenForCurvature) {
    std::mt19937_64 random(63);
    const auto fit = fitLinearity(sweep(0.003, 0.2, random, 5), kBlack);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->offsetDn, 5, 4 * fit->uOffsetDn + 0.003 * 4 * 5);
    EXPECT_LT(fit->uOffsetDn, 0.5);
    EXPECT_NEAR(fit->inlPercent, 0.2, 0.02);
    EXPECT_NEAR(fit->rate / kRate, 1, 0.01);
}

TEST(Linearity, APointOfTheSweepIsTheMeanAboveTheDark) {
    std::mt19937_64 random(64);
    const std::vector<test::Shot> shots{{.electronsPerSecond = 2e6, .seconds = 1e-3}};
    const DarkLibrary darks = test::perfectDarks(shots, {50, 40});
    std::vector<Frame> frames;
    for (int i = 0; i < 3; ++i) frames.push_back(test::take(shots[0], {50, 40}, random));
    const auto points = sweepPoints(frames, Band::G, darks, {});
    ASSERT_TRUE(points) << points.error().message;
    ASSERT_EQ(points->size(), 1U);
    const SweepPoint& point = points->front();
    EXPECT_DOUBLE_EQ(point.tau, 1e-3);
    EXPECT_NEAR(point.meanDn, 2000 / 2.6, 4 * point.u);
    EXPECT_NEAR(point.u, std::sqrt((2000 + 2.4 * 2.4) / 6000) / 2.6, 1e-3);
    // Saturated: refused, not cut off.
    frames.push_back(test::take({.electronsPerSecond = 2e7, .seconds = 1e-3}, {50, 40}, random));
    const auto refusal = sweepPoints(frames, Band::G, darks, {});
    ASSERT_FALSE(refusal);
    EXPECT_EQ(refusal.error().kind, ErrorKind::Quality);
    EXPECT_FALSE(sweepPoints({}, Band::G, darks, {}));
}

/// Frames of exposures up to just below saturation; the light of a pixel is times `share(x)`.
template <class Share>
Result<std::vector<SweepPoint>> sweepOf(Size size, const Share& share) {
    std::mt19937_64 random(66);
    std::vector<test::Shot> shots;
    for (int i = 1; i <= 8; ++i) shots.push_back({.seconds = 1e-3 * i});
    Image<double> light(size);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) light.at(x, y) = 1.22e6 * share(x);
    std::vector<Frame> frames;
    for (const test::Shot& shot : shots) frames.push_back(test::takeScene(light, shot, random));
    const DarkLibrary darks = test::perfectDarks(shots, size);
    return sweepPoints(frames, Band::G, darks, {});
}

TEST(Linearity, PixelsThatSaturateInOneExposureAreLeftOutOfAll) {
    // One column in 128 is 6 % brighter, and saturates in the last exposure: left out of that
    // alone, it would bend a proportional sensor by 0.05 %.
    const auto points = sweepOf({256, 100}, [](int x) { return x == 64 || x == 65 ? 1.06 : 1; });
    ASSERT_TRUE(points) << points.error().message;
    ASSERT_EQ(points->size(), 8U);
    for (const SweepPoint& point : *points)
        EXPECT_NEAR(point.meanDn, 1.22e6 * point.tau / 2.6, 4 * point.u) << point.tau;
}

TEST(Linearity, AnUnevenSceneIsRefused) {
    const auto uneven = sweepOf({40, 40}, [](int x) { return 0.8 + 0.2 * x / 40.0; });
    ASSERT_FALSE(uneven);
    EXPECT_NE(uneven.error().message.find("lit evenly"), std::string::npos)
        << uneven.error().message;
    EXPECT_TRUE(sweepOf({40, 40}, [](int x) { return 0.9 + 0.1 * x / 40.0; }));
}

TEST(Linearity, RefusesASweepThatCannotTell) {
    std::mt19937_64 random(65);
    const auto refuses = [](std::vector<SweepPoint> points, int degree = 3) {
        const auto fit = fitLinearity(points, kBlack, degree);
        return !fit && fit.error().kind == ErrorKind::Quality;
    };
    const std::vector<SweepPoint> good = sweep(0.003, 0.2, random);
    EXPECT_FALSE(refuses(good));
    EXPECT_TRUE(refuses({}));
    EXPECT_TRUE(refuses({good.begin(), good.begin() + 4}));
    EXPECT_TRUE(refuses(good, 1));
    EXPECT_TRUE(refuses(good, 7));
    EXPECT_TRUE(refuses(std::vector<SweepPoint>(16, good[3])));
    auto bad = good;
    bad[2].u = 0;
    EXPECT_TRUE(refuses(bad));
    bad = good;
    bad[2].meanDn = std::nan("");
    EXPECT_TRUE(refuses(bad));
    bad = good;
    bad[2].tau = 0;
    EXPECT_TRUE(refuses(bad));
    bad = good;
    for (SweepPoint& point : bad) point.meanDn = -1;
    EXPECT_TRUE(refuses(bad));
}

}  // namespace
}  // namespace gonio::proc
