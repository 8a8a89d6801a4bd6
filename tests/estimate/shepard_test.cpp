#include "proc/estimate/shepard.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "proc/core/median.h"
#include "tests/estimate/made_up.h"
#include "tests/support/retroreflective.h"

namespace gonio::proc {
namespace {

using test::made;
using test::pairAt;
using test::sampleAt;
using test::setOf;

double chord(double degrees) { return 2 * std::sin(degrees * kPi / 360); }

/// Three samples at 10, 12 and 15 degrees, asked at 11: chords of 1, 1 and 4 degrees.
ScatteredSet three() {
    return setOf(
        {sampleAt(pairAt(0, 10), 1), sampleAt(pairAt(0, 12), 2), sampleAt(pairAt(0, 15), 7)});
}

TEST(Shepard, WeighsByTheInverseSquareOfTheDistance) {
    const auto shepard = made(makeShepard(three(), {.fewest = 3, .most = 3}));
    const Answer answer = shepard->answer(pairAt(0, 11));
    const double near = 1 / (chord(1) * chord(1)), far = 1 / (chord(4) * chord(4));
    const double total = 2 * near + far;
    EXPECT_NEAR(answer.f[Band::R], (near * 1 + near * 2 + far * 7) / total, 1e-12);
    EXPECT_NEAR(answer.f[Band::B], 3 * answer.f[Band::R], 1e-12);
    EXPECT_NEAR((*answer.uRandom)[Band::R],
                0.1 * std::sqrt(near * near * (1 + 4) + far * far * 49) / total,
                1e-12);
    EXPECT_NEAR((*answer.uSystematic)[Band::R], 0.05 * answer.f[Band::R], 1e-12);
    EXPECT_EQ(answer.source, Source::Interpolated);
    EXPECT_EQ(answer.flags, Flags{Flag::Interpolated});
}

TEST(Shepard, AddsEpsilonToTheDistance) {
    constexpr double kEpsilon = 0.01;
    const auto shepard = made(makeShepard(three(), {.most = 3, .epsilon = kEpsilon}));
    const auto weight = [](double degrees) { return std::pow(chord(degrees) + kEpsilon, -2); };
    EXPECT_NEAR(shepard->answer(pairAt(0, 11)).f[Band::R],
                (weight(1) * 1 + weight(1) * 2 + weight(4) * 7) / (2 * weight(1) + weight(4)),
                1e-12);
    // At a sample the others weigh in too.
    const Answer at = shepard->answer(pairAt(0, 12));
    EXPECT_NEAR(
        at.f[Band::R],
        (weight(2) * 1 + weight(0) * 2 + weight(3) * 7) / (weight(2) + weight(0) + weight(3)),
        1e-12);
    EXPECT_EQ(at.source, Source::Interpolated);
}

TEST(Shepard, AnswersASampleAtItsPair) {
    const auto shepard = made(makeShepard(three()));
    const Answer answer = shepard->answer(pairAt(0, 12));
    EXPECT_EQ(answer.f, (LedBands{{2, 4, 6}}));
    EXPECT_EQ((*answer.uRandom)[Band::R], 0.2);
    EXPECT_EQ(answer.source, Source::Measured);
    EXPECT_EQ(answer.flags, Flags{Flag::Measured});
    // Isotropic: turned by a common angle it is the same pair.
    const LightView turned{.in = pairAt(0, 0).in, .out = pairAt(0, 12, 123).out};
    EXPECT_EQ(shepard->answer(turned).source, Source::Measured);
}

TEST(Shepard, AnswersTheMeanOfEqualPairs) {
    const auto shepard = made(makeShepard(setOf(
        {sampleAt(pairAt(20, 12), 1), sampleAt(pairAt(20, 12), 2), sampleAt(pairAt(20, 30), 9)})));
    const Answer answer = shepard->answer(pairAt(20, 12));
    EXPECT_DOUBLE_EQ(answer.f[Band::R], 1.5);
    EXPECT_DOUBLE_EQ((*answer.uRandom)[Band::R], std::hypot(0.1, 0.2) / 2);
    EXPECT_DOUBLE_EQ((*answer.uSystematic)[Band::R], 0.05 * 1.5);
    EXPECT_EQ(answer.source, Source::Measured);
}

TEST(Shepard, AnswersNothingWithFewerNeighboursThanItNeeds) {
    const ShepardOptions options{.fewest = 3, .most = 3, .maxDistance = chord(3.9)};
    const auto shepard = made(makeShepard(three(), options));
    EXPECT_FALSE(shepard->answer(pairAt(0, 11)).present());  // the third is 4 degrees away
    EXPECT_TRUE(shepard->answer(pairAt(0, 11.5)).present());
    EXPECT_FALSE(made(makeShepard(ScatteredSet{}))->answer(pairAt(0, 0)).present());
}

TEST(Shepard, ReproducesAConstantFromSamplesOfAnyPlace) {
    const auto shepard =
        made(makeShepard(test::gridOf([](double, double, double) { return 0.25; })));
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 300; ++i) {
        const Answer answer =
            shepard->answer(pairAt(60 * unit(random), 75 * unit(random), 360 * unit(random)));
        EXPECT_NEAR(answer.f[Band::R], 0.25, 1e-14);
        EXPECT_NEAR((*answer.uSystematic)[Band::R], 0.05 * 0.25, 1e-14);
        EXPECT_LE((*answer.uRandom)[Band::R], 0.1 * 0.25 + 1e-14);
    }
}

TEST(Shepard, HandlesOneSampleAndTheEndsOfTheAngles) {
    const auto shepard =
        made(makeShepard(setOf({sampleAt(pairAt(0, 0), 0.5)}),
                         {.maxDistance = std::numeric_limits<double>::infinity()}));
    EXPECT_EQ(shepard->answer(pairAt(0, 0)).source, Source::Measured);
    const Answer far = shepard->answer(pairAt(89.9, 89.9, 45));
    EXPECT_DOUBLE_EQ(far.f[Band::R], 0.5);
    EXPECT_EQ(far.source, Source::Interpolated);
    EXPECT_EQ(shepard->answer(pairAt(0, 120)).flags, Flags{Flag::BelowHorizon});
    EXPECT_EQ(shepard->answer(pairAt(95, 10)).flags, Flags{Flag::BelowHorizon});
}

TEST(Shepard, KeepsAMillionToOne) {
    const auto shepard =
        made(makeShepard(setOf({sampleAt(pairAt(0, 10), 1e-3), sampleAt(pairAt(0, 11), 1e3)})));
    double before = 0;
    for (double theta = 10; theta <= 11; theta += 0.05) {
        const double f = shepard->answer(pairAt(0, theta)).f[Band::R];
        EXPECT_GT(f, before);
        before = f;
    }
    EXPECT_EQ(shepard->answer(pairAt(0, 11)).f[Band::R], 1e3);
}

TEST(Shepard, RefusesOptionsOutOfTheirDomain) {
    const double nan = std::nan("");
    for (const ShepardOptions& bad : {ShepardOptions{.fewest = 0},
                                      ShepardOptions{.fewest = 5, .most = 4},
                                      ShepardOptions{.maxDistance = 0},
                                      ShepardOptions{.maxDistance = nan},
                                      ShepardOptions{.epsilon = -1},
                                      ShepardOptions{.epsilon = nan}}) {
        test::expectUsageError(makeShepard(three(), bad));
    }
}

// One sample in ten left out comes back within a few per cent in the middle: the set is dense and
// irregular, with a lobe at the mirror direction and one back towards the light.
TEST(Shepard, PredictsLeftOutSamplesOfARetroreflectiveTape) {
    const auto samples = gonio::test::retroreflectiveTape();
    if (samples.empty()) return;
    std::vector<ScatteredSample> kept, left;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        (i % 10 == 3 ? left : kept).push_back(samples[i]);
    }
    const auto shepard = made(makeShepard(setOf(kept), {.most = 8}));
    std::vector<double> errors;
    for (const ScatteredSample& sample : left) {
        const Answer answer = shepard->answer(sample.pair);
        ASSERT_TRUE(answer.present());
        errors.push_back(std::abs(answer.f[Band::R] / sample.f[Band::R] - 1));
    }
    EXPECT_LT(median(errors), 0.05);
    EXPECT_GT(median(errors), 1e-4);  // none of them answered itself
}

}  // namespace
}  // namespace gonio::proc
