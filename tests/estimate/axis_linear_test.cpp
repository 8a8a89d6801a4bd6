#include "proc/estimate/axis_linear.h"

#include <cmath>
#include <random>

#include "tests/estimate/made_up.h"

namespace gonio::proc {
namespace {

using test::gridOf;
using test::made;
using test::pairAt;
using test::sampleAt;
using test::setOf;

/// Linear in each angle; phi by its distance from 0, so that it closes.
double linear(double i, double o, double phi) {
    return 2 + 0.01 * i - 0.02 * o + 0.003 * std::min(phi, 360 - phi);
}

std::unique_ptr<Scatterer> estimator(const ScatteredSet& set) {
    return made(makeAxisLinear(set, {.incoming = 21_deg, .outgoing = 20_deg}));
}

TEST(AxisLinear, ReproducesWhatIsLinearInTheAngles) {
    const auto linearly = estimator(gridOf(linear));
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int k = 0; k < 2000; ++k) {
        const double i = 60 * unit(random), phi = 360 * unit(random);
        const double o = 5 + 70 * unit(random);  // the pole's 24 samples are one place
        const double turn = 2 * kPi * unit(random);
        LightView pair = pairAt(i, o, phi);
        pair = {.in = pair.in.turned(Radians(turn)), .out = pair.out.turned(Radians(turn))};
        const Answer answer = linearly->answer(pair);
        EXPECT_NEAR(answer.f[Band::R], linear(i, o, phi), 1e-12);
        EXPECT_NEAR((*answer.uSystematic)[Band::R], 0.05 * answer.f[Band::R], 1e-12);
        EXPECT_EQ(answer.flags, Flags{Flag::Interpolated});
    }
}

TEST(AxisLinear, AnswersASampleAtItsPair) {
    const auto linearly = estimator(gridOf(linear));
    for (const LightView& pair : {pairAt(20, 35, 30), pairAt(60, 75, 345), pairAt(0, 5, 15)}) {
        const Answer answer = linearly->answer(pair);
        EXPECT_EQ(answer.source, Source::Measured);
        EXPECT_EQ(answer.flags, Flags{Flag::Measured});
    }
    EXPECT_EQ(linearly->answer(pairAt(20, 35, 31)).source, Source::Interpolated);
}

TEST(AxisLinear, HoldsTheLastValueBesideTheDataUntilItsReachEnds) {
    const auto linearly =
        made(makeAxisLinear(gridOf(linear), {.incoming = 5_deg, .outgoing = 20_deg}));
    EXPECT_NEAR(linearly->answer(pairAt(64, 30)).f[Band::R], linear(60, 30, 0), 1e-12);
    EXPECT_EQ(linearly->answer(pairAt(64, 30)).source, Source::Interpolated);
    EXPECT_FALSE(linearly->answer(pairAt(66, 30)).present());
    EXPECT_NEAR(linearly->answer(pairAt(20, 89)).f[Band::R], linear(20, 75, 0), 1e-12);
    EXPECT_FALSE(linearly->answer(pairAt(30, 30)).present());  // 10 degrees from either plane
}

TEST(AxisLinear, LooksPastAMissingNeighbour) {
    ScatteredSet set = gridOf(linear);
    const auto hole = set.nearest(pairAt(20, 35, 30), {});
    ASSERT_TRUE(set.remove(hole.front().id));
    const Answer answer = estimator(set)->answer(pairAt(20, 35, 30));
    EXPECT_NEAR(answer.f[Band::R], linear(20, 35, 30), 1e-12);
    EXPECT_EQ(answer.source, Source::Interpolated);
}

TEST(AxisLinear, FindsNeighboursAcrossPhiZero) {
    const auto linearly =
        estimator(setOf({sampleAt(pairAt(20, 40, 350), 1), sampleAt(pairAt(20, 40, 10), 3)}));
    EXPECT_NEAR(linearly->answer(pairAt(20, 40, 0)).f[Band::R], 2, 1e-12);
    EXPECT_NEAR(linearly->answer(pairAt(20, 40, 355)).f[Band::R], 1.5, 1e-12);
    EXPECT_NEAR(linearly->answer(pairAt(20, 40, 5)).f[Band::R], 2.5, 1e-12);
    EXPECT_FALSE(linearly->answer(pairAt(20, 40, 180)).present());
}

TEST(AxisLinear, FoldsAPlaneSymmetricSet) {
    const ScatteredSet half = setOf(
        {sampleAt(pairAt(20, 40, 10), 1), sampleAt(pairAt(20, 40, 30), 3)}, PairSymmetry::Plane);
    const auto linearly = estimator(half);
    EXPECT_NEAR(linearly->answer(pairAt(20, 40, 340)).f[Band::R], 2, 1e-12);
    EXPECT_NEAR(linearly->answer(pairAt(20, 40, 0)).f[Band::R], 1, 1e-12);
    EXPECT_EQ(linearly->answer(pairAt(20, 40, 350)).source, Source::Measured);
}

TEST(AxisLinear, KeepsTheAzimuthOfAnAnisotropicSet) {
    std::vector<ScatteredSample> samples;
    for (const double turn : {0.0, 90.0}) {
        LightView pair = pairAt(20, 40);
        const Radians angle = Radians::fromDegrees(turn);
        pair = {.in = pair.in.turned(angle), .out = pair.out.turned(angle)};
        samples.push_back(sampleAt(pair, 1 + turn));
    }
    const auto linearly = estimator(setOf(samples, PairSymmetry::None));
    EXPECT_EQ(linearly->answer(samples[0].pair).f[Band::R], 1);
    EXPECT_EQ(linearly->answer(samples[1].pair).f[Band::R], 91);
}

TEST(AxisLinear, HandlesOneSampleAndTwoEqualOnes) {
    const auto one = estimator(setOf({sampleAt(pairAt(0, 0), 0.5)}));
    EXPECT_EQ(one->answer(pairAt(0, 0)).source, Source::Measured);
    EXPECT_EQ(one->answer(pairAt(0, 19)).f[Band::R], 0.5);
    EXPECT_FALSE(one->answer(pairAt(0, 21)).present());
    const auto two = estimator(setOf({sampleAt(pairAt(20, 10), 1), sampleAt(pairAt(20, 10), 3)}));
    EXPECT_DOUBLE_EQ(two->answer(pairAt(20, 10)).f[Band::R], 2);
    EXPECT_FALSE(estimator(ScatteredSet{})->answer(pairAt(0, 0)).present());
    EXPECT_EQ(one->answer(pairAt(0, 100)).flags, Flags{Flag::BelowHorizon});
}

TEST(AxisLinear, LooksAtNoMorePointsThanItMay) {
    const ScatteredSet grid = gridOf(linear);
    // A coordinate of each of four axes leads to the first sample.
    EXPECT_TRUE(made(makeAxisLinear(grid, {.maxPoints = 4}))->answer(pairAt(20, 35)).present());
    EXPECT_FALSE(made(makeAxisLinear(grid, {.maxPoints = 3}))->answer(pairAt(20, 35)).present());
}

TEST(AxisLinear, RefusesOptionsOutOfTheirDomain) {
    for (const AxisReach& bad : {AxisReach{.incoming = Radians(-1)},
                                 AxisReach{.outgoing = Radians(std::nan(""))},
                                 AxisReach{.maxPoints = 0}}) {
        test::expectUsageError(makeAxisLinear(ScatteredSet{}, bad));
    }
}

}  // namespace
}  // namespace gonio::proc
