#include <cmath>
#include <random>

#include "proc/estimate/bezier_extrapolator.h"
#include "proc/estimate/clamp_extrapolator.h"
#include "proc/estimate/gradient_extrapolator.h"
#include "proc/estimate/linear_extrapolator.h"
#include "proc/estimate/no_extrapolation.h"
#include "tests/estimate/made_up.h"

namespace gonio::proc {
namespace {

using test::Everywhere;
using test::made;
using test::pairAt;

std::unique_ptr<Scatterer> inner(const test::OfAngles& f) {
    return std::make_unique<Everywhere>(f);
}

double slope(double, double o, double) { return 2 - 0.02 * o; }
double constant(double, double, double) { return 0.5; }

constexpr Beyond kOut{Side::Outgoing, 75_deg};
constexpr Beyond kIn{Side::Incoming, 60_deg};

/// Each method over the same inner one.
std::vector<std::unique_ptr<Scatterer>> methods(const test::OfAngles& f, const Beyond& beyond) {
    std::vector<std::unique_ptr<Scatterer>> all;
    all.push_back(made(makeClampExtrapolator(inner(f), beyond)));
    all.push_back(made(makeLinearExtrapolator(inner(f), beyond)));
    all.push_back(made(makeBezierExtrapolator(inner(f), beyond)));
    all.push_back(made(makeGradientExtrapolator(inner(f), beyond)));
    return all;
}

TEST(Extrapolators, HandOnWhatIsInsideUnchanged) {
    const auto everywhere = inner(slope);
    for (const auto& method : methods(slope, kOut)) {
        for (const LightView& pair : {pairAt(80, 0), pairAt(10, 74.999, 30), pairAt(0, 75)}) {
            const Answer answer = method->answer(pair);
            EXPECT_EQ(answer.f, everywhere->answer(pair).f);
            EXPECT_EQ(answer.source, Source::Measured);
            EXPECT_EQ(answer.flags, (Flags{Flag::Measured, Flag::GlareCorrected}));
        }
    }
}

TEST(Extrapolators, AreContinuousAtTheEdgeOnBothSides) {
    const auto byBoth = [](double i, double o, double phi) {
        return 3 - 0.02 * i - 0.01 * o + 0.1 * std::cos(phi * kPi / 180);
    };
    constexpr double kTiny = 1e-7;
    for (const double phi : {0.0, 100.0, 300.0}) {
        // The steepest is the gradient, which falls by (1 - p) (1 - l) / (l m) = 7.2 f a radian:
        // by 4e-8 here.
        for (const auto& method : methods(byBoth, kOut)) {
            EXPECT_NEAR(
                method->answer(pairAt(20, 75 + kTiny, phi)).f[Band::R], byBoth(20, 75, phi), 1e-6);
        }
        for (const auto& method : methods(byBoth, kIn)) {
            EXPECT_NEAR(
                method->answer(pairAt(60 + kTiny, 30, phi)).f[Band::R], byBoth(60, 30, phi), 1e-6);
        }
    }
}

TEST(Extrapolators, SayThatTheyExtrapolate) {
    for (const auto& method : methods(slope, kOut)) {
        const Answer answer = method->answer(pairAt(20, 80));
        EXPECT_EQ(answer.source, Source::Extrapolated);
        EXPECT_EQ(answer.flags, (Flags{Flag::GlareCorrected, Flag::Extrapolated}));
        EXPECT_TRUE(answer.uRandom);
    }
}

TEST(Extrapolators, AnswerNothingWithoutAValueAtTheEdge) {
    for (int which = 0; which < 4; ++which) {
        auto nowhere = std::make_unique<test::Nowhere>();
        const auto method = which == 0   ? made(makeClampExtrapolator(std::move(nowhere)))
                            : which == 1 ? made(makeLinearExtrapolator(std::move(nowhere)))
                            : which == 2 ? made(makeBezierExtrapolator(std::move(nowhere)))
                                         : made(makeGradientExtrapolator(std::move(nowhere)));
        for (const double theta : {75.1, 80.0, 90.0}) {
            const Answer answer = method->answer(pairAt(20, theta));
            EXPECT_FALSE(answer.present()) << which << " at " << theta;
            EXPECT_EQ(answer.source, Source::Extrapolated);
            EXPECT_TRUE(answer.flags.has(Flag::Blocked));
        }
    }
}

TEST(Extrapolators, AnswerNothingBelowTheHorizon) {
    for (const auto& method : methods(slope, kOut)) {
        EXPECT_EQ(method->answer(pairAt(20, 91)).flags, Flags{Flag::BelowHorizon});
        EXPECT_EQ(method->answer(pairAt(91, 20)).flags, Flags{Flag::BelowHorizon});
    }
}

TEST(Extrapolators, RefuseAnEdgeOutsideTheHemisphere) {
    for (const Radians edge : {-1_deg, 90_deg, Radians(std::nan(""))}) {
        const Beyond bad{Side::Outgoing, edge};
        test::expectUsageError(makeNoExtrapolation(inner(slope), bad));
        test::expectUsageError(makeClampExtrapolator(inner(slope), bad));
        test::expectUsageError(makeLinearExtrapolator(inner(slope), bad));
        test::expectUsageError(makeBezierExtrapolator(inner(slope), bad));
        test::expectUsageError(makeGradientExtrapolator(inner(slope), bad));
    }
}

TEST(NoExtrapolation, AnswersNothingBeyondTheEdge) {
    const auto none = made(makeNoExtrapolation(inner(slope), kOut));
    EXPECT_TRUE(none->answer(pairAt(20, 75)).present());
    const Answer beyond = none->answer(pairAt(20, 75.01));
    EXPECT_FALSE(beyond.present());
    EXPECT_EQ(beyond.source, Source::Extrapolated);
}

TEST(ClampExtrapolator, HoldsTheValueAndItsUncertainty) {
    const auto clamp = made(makeClampExtrapolator(inner(slope), kOut));
    for (const double theta : {76.0, 85.0, 90.0}) {
        const Answer answer = clamp->answer(pairAt(20, theta, 40));
        EXPECT_NEAR(answer.f[Band::B], 3 * slope(0, 75, 0), 1e-12);
        EXPECT_NEAR((*answer.uRandom)[Band::B], 0.3 * slope(0, 75, 0), 1e-12);
        EXPECT_NEAR((*answer.uSystematic)[Band::B], 0.15 * slope(0, 75, 0), 1e-12);
    }
}

TEST(LinearExtrapolator, FallsToZeroAtNinetyDegrees) {
    const auto falls = made(makeLinearExtrapolator(inner(slope), kOut));
    const double edge = slope(0, 75, 0);
    EXPECT_NEAR(falls->answer(pairAt(20, 80)).f[Band::R], edge * 2 / 3, 1e-12);
    EXPECT_NEAR((*falls->answer(pairAt(20, 80)).uRandom)[Band::R], 0.1 * edge * 2 / 3, 1e-12);
    const Answer end = falls->answer(pairAt(20, 90));
    EXPECT_NEAR(end.f[Band::R], 0, 1e-15);
    EXPECT_TRUE(end.present());
    const auto incoming = made(makeLinearExtrapolator(inner(constant), kIn));
    EXPECT_NEAR(incoming->answer(pairAt(75, 30, 50)).f[Band::R], 0.25, 1e-12);
}

TEST(BezierExtrapolator, LeavesAlongTheTangentAndEndsAtZero) {
    const auto bezier = made(makeBezierExtrapolator(inner(slope), kOut));
    const double f = slope(0, 75, 0);  // 0.5, falling by 0.02 a degree
    constexpr double kStep = 1e-4;
    EXPECT_NEAR((bezier->answer(pairAt(20, 75 + kStep)).f[Band::R] - f) / kStep, -0.02, 1e-5);
    EXPECT_NEAR(bezier->answer(pairAt(20, 90)).f[Band::R], 0, 1e-15);
    // Half way: a quarter of the first point, half of the middle one, f - 0.02 x 7.5.
    EXPECT_NEAR(bezier->answer(pairAt(20, 82.5)).f[Band::R], f / 4 + (f - 0.15) / 2, 1e-10);
}

TEST(BezierExtrapolator, WidensTheNoiseByTheTangent) {
    const auto bezier = made(makeBezierExtrapolator(inner(constant), kOut));
    const Answer answer = bezier->answer(pairAt(20, 82.5));
    // f / 4 + (f + 7.5 (f - f')) / 2, the two values of 10 % each.
    EXPECT_NEAR(answer.f[Band::R], 0.375, 1e-12);
    EXPECT_NEAR((*answer.uRandom)[Band::R], 0.05 * std::hypot(0.25 + 0.5 * 8.5, 0.5 * 7.5), 1e-10);
    EXPECT_NEAR((*answer.uSystematic)[Band::R], 0.05 * 0.375, 1e-12);
}

TEST(BezierExtrapolator, DoesNotFallBelowZeroOnASteepFlank) {
    const auto flank = [](double, double o, double) { return std::exp(-(o - 60)); };
    const auto bezier = made(makeBezierExtrapolator(inner(flank), kOut));
    for (double theta = 75.1; theta <= 90; theta += 0.5) {
        const double part = (theta - 75) / 15;
        EXPECT_NEAR(bezier->answer(pairAt(20, theta)).f[Band::G],
                    2 * flank(0, 75, 0) * (1 - part) * (1 - part),
                    1e-12);
    }
    // Noise below 0 stays what it is and comes up to 0, in its own band alone.
    const auto negative = [](double, double o, double) { return o > 74.5 ? -0.1 : 5.0; };
    const auto noisy = made(makeBezierExtrapolator(inner(negative), kOut));
    for (double theta = 75.1; theta <= 90; theta += 0.5) {
        const double f = noisy->answer(pairAt(20, theta)).f[Band::R];
        EXPECT_GE(f, -0.1);
        EXPECT_LE(f, 1e-15);
    }
}

TEST(BezierExtrapolator, RefusesAStepThatLeavesTheHemisphere) {
    for (const Radians step : {0_deg, -1_deg, 76_deg, Radians(std::nan(""))}) {
        test::expectUsageError(makeBezierExtrapolator(inner(slope), kOut, {.step = step}));
    }
}

TEST(BentStep, SolvesItsBezierCurve) {
    for (const double l : {0.0, 1e-12, 0.1, 0.3, 0.4999999, 0.5, 0.5000001, 0.7, 0.9, 1.0}) {
        for (int k = 0; k <= 1000; ++k) {
            const double x = k / 1000.0;
            const double y = bentStep(x, l);
            // Of eq. 40, x + y = 2 (1 - s) s + 2 s^2 = 2 s: the parameter without solving for it.
            const double s = (x + y) / 2;
            EXPECT_GE(s, 0);
            EXPECT_LE(s, 1 + 1e-15);
            EXPECT_NEAR(2 * (1 - s) * s * l + s * s, x, 1e-15);
            EXPECT_NEAR(2 * (1 - s) * s * (1 - l) + s * s, y, 1e-15);
        }
    }
}

TEST(BentStep, HasItsEndsAndItsThreeForms) {
    for (const double l : {0.0, 0.2, 0.5, 0.8, 1.0}) {
        EXPECT_EQ(bentStep(0, l), 0);
        EXPECT_DOUBLE_EQ(bentStep(1, l), 1);
    }
    for (double x = 0; x <= 1; x += 0.01) {
        EXPECT_NEAR(bentStep(x, 0.5), x, 1e-15);
        EXPECT_NEAR(bentStep(x, 0), 2 * std::sqrt(x) - x, 1e-15);
        EXPECT_NEAR(bentStep(x, 1), std::pow(1 - std::sqrt(1 - x), 2), 1e-15);
        // The curve of 1 - l is that of l turned by half a turn about the middle.
        EXPECT_NEAR(bentStep(x, 0.3), 1 - bentStep(1 - x, 0.7), 1e-14);
    }
}

TEST(GradientExtrapolator, GoesFromTheEdgeToItsPart) {
    const GradientOptions options{.ratio = 0.2, .distance = 0.2, .bend = 0.3};
    const auto gradient = made(makeGradientExtrapolator(inner(constant), kOut, options));
    const auto chord = [](double degrees) { return 2 * std::sin(degrees * kPi / 360); };
    for (const double away : {0.5, 3.0, 8.0, 11.0}) {
        const double t = bentStep(chord(away) / 0.2, 0.3);
        const Answer answer = gradient->answer(pairAt(20, 75 + away, 70));
        EXPECT_NEAR(answer.f[Band::R], 0.5 * (1 - t) + t * 0.2 * 0.5, 1e-12);
        EXPECT_NEAR((*answer.uRandom)[Band::R], 0.1 * answer.f[Band::R], 1e-12);
    }
    // 11.5 degrees and more are beyond the distance.
    for (const double theta : {86.6, 90.0}) {
        EXPECT_NEAR(gradient->answer(pairAt(20, theta)).f[Band::R], 0.1, 1e-12);
    }
}

TEST(GradientExtrapolator, RefusesOptionsOutOfTheirDomain) {
    const double nan = std::nan("");
    for (const GradientOptions& bad : {GradientOptions{.ratio = -0.1},
                                       GradientOptions{.ratio = nan},
                                       GradientOptions{.distance = 0},
                                       GradientOptions{.distance = nan},
                                       GradientOptions{.bend = -0.01},
                                       GradientOptions{.bend = 1.01},
                                       GradientOptions{.bend = nan}}) {
        test::expectUsageError(makeGradientExtrapolator(inner(slope), kOut, bad));
    }
}

}  // namespace
}  // namespace gonio::proc
