// Scenes and brackets at the ends of what can come, with floating-point traps on: an invalid
// operation, a division by zero or an overflow ends the test.

#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <vector>

#include "proc/radiance/frame_residuals.h"
#include "proc/radiance/group_scales.h"
#include "proc/radiance/merge.h"
#include "proc/radiance/poisson_check.h"
#include "tests/radiance/frames.h"

namespace gonio::proc {
namespace {

using test::Hot;
using test::Shot;
using test::take;

constexpr Size kSize{100, 80};

class MergeExtremes : public ::testing::Test {
protected:
    MergeExtremes() { feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW); }
    ~MergeExtremes() override { fedisableexcept(FE_ALL_EXCEPT); }
    MergeExtremes(const MergeExtremes&) = delete;
    MergeExtremes& operator=(const MergeExtremes&) = delete;

    std::mt19937_64 random_{81};
};

/// Dark frames as they are taken: four of each exposure.
DarkLibrary takenDarks(const std::vector<Shot>& shots,
                       const SensorNoise& noise,
                       std::mt19937_64& random,
                       const std::vector<Hot>& hot = {}) {
    DarkLibrary library;
    for (Shot shot : shots) {
        shot.level = 0;
        std::vector<Frame> frames;
        for (int i = 0; i < 4; ++i) frames.push_back(take(shot, kSize, random, hot, noise));
        library.add(*averageDark(frames, noise));
    }
    return library;
}

/// Merges, and looks at it in every way that there is.
MergedState merged(const std::vector<Frame>& frames,
                   const DarkLibrary& darks,
                   const SensorNoise& noise) {
    MergeAccumulator accumulator(Band::G, darks, noise);
    for (const Frame& frame : frames) EXPECT_TRUE(accumulator.add(frame));
    const auto state = mergeSums(accumulator.sums());
    EXPECT_TRUE(state);
    for (std::size_t i = 0; i < state->radiance.pixels().size(); ++i) {
        const bool data = state->used.pixels()[i] > 0;
        EXPECT_EQ(std::isfinite(state->radiance.pixels()[i]), data);
        EXPECT_EQ(std::isfinite(state->variance.pixels()[i]), data);
        EXPECT_TRUE(!data || state->variance.pixels()[i] > 0);
    }
    const ScaleReport scales = groupScales(accumulator.sums(), *state);
    for (const GroupScale& scale : scales.groups) {
        EXPECT_TRUE(std::isfinite(scale.offset.size));
        EXPECT_GT(scale.offset.u, 0);
        EXPECT_LT(std::abs(scale.offset.size), 5 * scale.uNominal);
    }
    EXPECT_FALSE(frameResiduals(accumulator.sums(), *state).change);
    const PoissonCheck check = poissonCheck(accumulator.sums(), *state);
    EXPECT_TRUE(std::isfinite(check.difference) && std::isfinite(check.u));
    return *state;
}

/// Mean square of the errors over their variances, over the pixels with data.
double pullSquares(const MergedState& state, double truth) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < state.radiance.pixels().size(); ++i) {
        if (state.used.pixels()[i] == 0) continue;
        const double error = static_cast<double>(state.radiance.pixels()[i]) - truth;
        sum += error * error / static_cast<double>(state.variance.pixels()[i]);
        ++count;
    }
    return sum / count;
}

std::vector<Frame> bracketOf(const std::vector<Shot>& shots,
                             double light,
                             std::mt19937_64& random,
                             const SensorNoise& noise = {},
                             const std::vector<Hot>& hot = {}) {
    std::vector<Frame> frames;
    for (Shot shot : shots) {
        shot.electronsPerSecond = light;
        frames.push_back(take(shot, kSize, random, hot, noise));
    }
    return frames;
}

// The mean square of 8000 pulls is 1 to 4 sqrt(2 / 8000) = 0.063; the dark frames are common to all
// samples of a pixel, and known to a quarter of their variance.
constexpr double kHonest = 0.1;

/// Where the light is lost in the noise, shot noise is estimated from the positive half of it: the
/// variance is too large by up to a quarter, never too small.
void expectCautious(double pullSquares) {
    EXPECT_LT(pullSquares, 1 + kHonest);
    EXPECT_GT(pullSquares, 0.75);
}

TEST_F(MergeExtremes, OneElectronPerPixel) {
    const std::vector<Shot> shots{{.seconds = 20e-6}, {.seconds = 1e-3}, {.seconds = 1e-3}};
    const DarkLibrary darks = takenDarks(shots, {}, random_);
    const MergedState state = merged(bracketOf(shots, 1000, random_), darks, {});
    expectCautious(pullSquares(state, 1000));
    double mean = 0;
    for (const float x : state.radiance.pixels()) mean += static_cast<double>(x) / 8000;
    // 3.4 electrons of noise in each of two frames and a quarter of it in the dark: 2.6 electrons.
    EXPECT_NEAR(mean, 1000, 4 * 2600 / std::sqrt(8000.0) + 30);
}

TEST_F(MergeExtremes, ATwentiethOfTheDiscIsSaturatedInEveryFrame) {
    const std::vector<Shot> shots{{.seconds = 20e-6}, {.seconds = 320e-6}};
    const DarkLibrary darks = takenDarks(shots, {}, random_);
    Image<double> light(kSize, 1e7);
    for (int y = 30; y < 50; ++y)
        for (int x = 40; x < 60; ++x) light.at(x, y) = 1e10;
    std::vector<Frame> frames;
    for (const Shot& shot : shots) frames.push_back(test::takeScene(light, shot, random_));
    const MergedState state = merged(frames, darks, {});
    EXPECT_GE(state.allSaturatedPixels, 400U);
    EXPECT_LE(state.allSaturatedPixels, 400U + 80U);  // and their neighbours
    EXPECT_EQ(state.used.at(50, 40), 0);
    EXPECT_EQ(state.saturated.at(50, 40), 2);
    EXPECT_NEAR(pullSquares(state, 1e7), 1, kHonest);
}

TEST_F(MergeExtremes, ZeroLight) {
    const std::vector<Shot> shots{{.seconds = 20e-6}, {.seconds = 1e-3}, {.seconds = 40e-3}};
    const DarkLibrary darks = takenDarks(shots, {}, random_);
    const MergedState state = merged(bracketOf(shots, 0, random_), darks, {});
    expectCautious(pullSquares(state, 0));
}

TEST_F(MergeExtremes, TwoFramesOfTheSameExposure) {
    const std::vector<Shot> shots{{.seconds = 1e-3}, {.seconds = 1e-3}};
    const DarkLibrary darks = takenDarks(shots, {}, random_);
    const MergedState state = merged(bracketOf(shots, 1e6, random_), darks, {});
    EXPECT_EQ(state.freedom, 0U);  // one group
    EXPECT_EQ(state.used.at(7, 7), 2);
    EXPECT_NEAR(pullSquares(state, 1e6), 1, kHonest);
}

TEST_F(MergeExtremes, TwoLevelsOfTheSameEffectiveTime) {
    // 1 : 1 between two groups: 0.5 ms at full level, 1 ms at half.
    const std::vector<Shot> shots{{.seconds = 0.5e-3}, {.seconds = 1e-3, .level = 32768}};
    const DarkLibrary darks = takenDarks(shots, {}, random_);
    const MergedState state = merged(bracketOf(shots, 1e6, random_), darks, {});
    EXPECT_EQ(state.freedom, 8000U);
    EXPECT_NEAR(pullSquares(state, 1e6), 1, kHonest);
}

TEST_F(MergeExtremes, OneFrameOnly) {
    const std::vector<Shot> shots{{.seconds = 1e-3}};
    const DarkLibrary darks = takenDarks(shots, {}, random_);
    const MergedState state = merged(bracketOf(shots, 1e6, random_), darks, {});
    EXPECT_EQ(state.freedom, 0U);
    EXPECT_EQ(state.chiSquare, 0);
    EXPECT_NEAR(pullSquares(state, 1e6), 1, kHonest);
}

TEST_F(MergeExtremes, EverySecondPixelIsHot) {
    std::vector<Hot> hot;
    for (int y = 0; y < kSize.height; ++y)
        for (int x = y % 2; x < kSize.width; x += 2) hot.push_back({x, y, 2e4});
    const std::vector<Shot> shots{{.seconds = 1e-3}, {.seconds = 40e-3}};
    const DarkLibrary darks = takenDarks(shots, {}, random_, hot);
    const MergedState state = merged(bracketOf(shots, 1e4, random_, {}, hot), darks, {});
    // A hot pixel is found against the average, which is half as high as they are here: its own
    // shot noise is known to half, and the normal ones' read noise is not changed by it.
    for (int y = 0; y < kSize.height; ++y)
        for (int x = 0; x < kSize.width; ++x)
            ASSERT_LT(std::abs(state.radiance.at(x, y) - 1e4F),
                      8 * std::sqrt(state.variance.at(x, y)));
}

TEST_F(MergeExtremes, AllPixelsAreHot) {
    // As much dark current in all: nothing stands out, the dark frames know their noise, and the
    // profile's dark current says that of the frames.
    const SensorNoise noise{.darkElectronsPerSecond = 3000};
    const std::vector<Shot> shots{{.seconds = 1e-3}, {.seconds = 40e-3}, {.seconds = 0.4}};
    const DarkLibrary darks = takenDarks(shots, noise, random_);
    const MergedState state = merged(bracketOf(shots, 5000, random_, noise), darks, noise);
    EXPECT_NEAR(pullSquares(state, 5000), 1, kHonest);
}

TEST_F(MergeExtremes, AtEightyDegrees) {
    // 3 e-/s at 25 degC, doubled every 7 K: 696 e-/s. 5.2 s then fill half the well in the dark.
    const SensorNoise noise{.darkElectronsPerSecond = 3 * std::pow(2, 55 / 7.0)};
    const std::vector<Shot> shots = test::wideLadder();
    const DarkLibrary darks = takenDarks(shots, noise, random_);
    for (const double light : {0.0, 420.0, 1e5}) {
        const MergedState state = merged(bracketOf(shots, light, random_, noise), darks, noise);
        EXPECT_NEAR(pullSquares(state, light), 1, kHonest) << light;
    }
}

TEST_F(MergeExtremes, APictureOfOnePixel) {
    const std::vector<Shot> shots{{.seconds = 1e-3}, {.seconds = 2e-3}};
    const DarkLibrary darks = test::perfectDarks(shots, {1, 1});
    std::vector<Frame> frames;
    for (Shot shot : shots) {
        shot.electronsPerSecond = 1e6;
        frames.push_back(take(shot, {1, 1}, random_));
    }
    const MergedState state = merged(frames, darks, {});
    EXPECT_NEAR(state.radiance.at(0, 0), 1e6, 6 * std::sqrt(state.variance.at(0, 0)));
}

}  // namespace
}  // namespace gonio::proc
