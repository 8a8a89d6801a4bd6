#include "proc/radiance/poisson_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/radiance/frames.h"

namespace gonio::proc {
namespace {

using test::perfectDarks;
using test::Shot;

constexpr Size kSize{150, 60};
const std::vector<Shot> kShots{{.seconds = 20e-6},
                               {.seconds = 320e-6},
                               {.seconds = 5120e-6},
                               {.seconds = 5120e-6},
                               {.seconds = 20e-6, .level = 3277}};

MergeAccumulator accumulated(const DarkLibrary& darks,
                             const SensorNoise& noise,
                             double peak,
                             std::mt19937_64& random) {
    MergeAccumulator accumulator(Band::G, darks, noise);
    for (const Shot& shot : kShots)
        EXPECT_TRUE(accumulator.add(test::takeScene(test::lobe(kSize, peak), shot, random)));
    return accumulator;
}

TEST(PoissonCheck, TheSumIsThatOfElectronsOverThatOfTimes) {
    const DarkLibrary darks = perfectDarks(kShots, kSize);
    std::mt19937_64 random(41);
    MergeAccumulator accumulator(Band::G, darks, {});
    std::vector<Frame> frames;
    for (const Shot& shot : kShots)
        frames.push_back(test::takeScene(test::lobe(kSize, 1e6), shot, random));
    for (const Frame& frame : frames) ASSERT_TRUE(accumulator.add(frame));
    const Image<float> sum = poissonSum(accumulator.sums());
    for (const auto& [x, y] : {std::pair{0, 0}, {127, 3}, {128, 3}, {149, 59}, {90, 30}}) {
        double electrons = 0, tau = 0;
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const double black = test::kBlackDn + 3.0 * kShots[i].seconds / 2.6;
            electrons += (frames[i].pixels.at(x, y) - black) * 2.6;
            tau += kShots[i].seconds * kShots[i].level / 65535.0;
        }
        EXPECT_NEAR(sum.at(x, y), electrons / tau, 1e-7 * electrons / tau + 1e-3) << x;
    }
}

TEST(PoissonCheck, AgreesWithTheMergeAndKnowsTheSpread) {
    const DarkLibrary darks = perfectDarks(kShots, kSize);
    std::mt19937_64 random(42);
    double squares = 0;
    constexpr int kRepeats = 12;
    for (int i = 0; i < kRepeats; ++i) {
        const MergeAccumulator accumulator = accumulated(darks, {}, 1e8, random);
        const auto state = mergeSums(accumulator.sums());
        ASSERT_TRUE(state);
        const PoissonCheck check = poissonCheck(accumulator.sums(), *state);
        EXPECT_GT(check.electrons, 1e6);
        EXPECT_LT(std::abs(check.difference), 0.0015 * check.electrons + 4 * check.u);
        squares += check.difference * check.difference / (check.u * check.u) / kRepeats;
    }
    // Weights from the pooled estimate of the same samples shift the mean a little besides.
    EXPECT_GT(squares, 0.4);
    EXPECT_LT(squares, 3);
}

TEST(PoissonCheck, SeesANoiseModelThatBiases) {
    // A dark frame that is 3 DN too high pulls at the two with different weights.
    DarkLibrary wrong;
    for (const Shot& shot : kShots) {
        const DarkLibrary right = perfectDarks({shot}, kSize);
        DarkFrame dark = **right.find(test::unexposed(shot, kSize));
        for (float& dn : dark.mean.pixels()) dn += 3;
        wrong.add(dark);
    }
    std::mt19937_64 random(43);
    const MergeAccumulator accumulator = accumulated(wrong, {}, 1e8, random);
    const auto state = mergeSums(accumulator.sums());
    ASSERT_TRUE(state);
    const PoissonCheck check = poissonCheck(accumulator.sums(), *state);
    EXPECT_GT(std::abs(check.difference), 8 * check.u);
}

TEST(PoissonCheck, IsNotANumberWhereNothingIsUsable) {
    const DarkLibrary darks = perfectDarks(kShots, kSize);
    std::mt19937_64 random(44);
    const MergeAccumulator accumulator = accumulated(darks, {}, 1e15, random);
    const auto state = mergeSums(accumulator.sums());
    ASSERT_TRUE(state);
    const PoissonCheck check = poissonCheck(accumulator.sums(), *state);
    EXPECT_EQ(check.electrons, 0);
    EXPECT_EQ(check.difference, 0);
    EXPECT_EQ(check.u, 0);
    EXPECT_TRUE(std::isnan(poissonSum(accumulator.sums()).at(75, 30)));
}

}  // namespace
}  // namespace gonio::proc
