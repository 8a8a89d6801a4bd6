// Planned against achieved: the captures of a plan, taken of synthetic pictures, merged and
// averaged over cells, have the random error that was predicted.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "proc/plan/prediction.h"
#include "proc/plan/shared_choice.h"
#include "proc/radiance/merge.h"
#include "tests/plan/small_rig.h"
#include "tests/radiance/frames.h"

namespace {

using namespace gonio;
using namespace gonio::proc;

constexpr int kCells = 600;
constexpr int kPixels = 16;

/// A row of pixels for each cell.
Frame picture(const StatePilot& state, const ShotKind& kind, std::mt19937_64& random) {
    const auto level = static_cast<std::uint16_t>(std::lround(kind.level * 65535));
    Frame whole;
    for (int y = 0; y < kCells; ++y) {
        const Frame row =
            test::take({.electronsPerSecond = state.cells[static_cast<std::size_t>(y)].rate,
                        .seconds = kind.exposure.count(),
                        .level = level},
                       {kPixels, 1},
                       random);
        if (y == 0) {
            whole = row;
            whole.pixels = Image<std::uint16_t>({kPixels, kCells});
            whole.window = {.size = {kPixels, kCells}};
        }
        std::copy(row.pixels.row(0).begin(), row.pixels.row(0).end(), whole.pixels.row(y).begin());
    }
    return whole;
}

Frame darkPicture(Seconds exposure, std::mt19937_64& random) {
    Frame dark = test::take({.seconds = exposure.count(), .level = 0}, {kPixels, kCells}, random);
    dark.led.reset();
    return dark;
}

/// All that the plan takes of its only state, merged.
MergedState carriedOut(const Plan& plan, const StatePilot& state, std::mt19937_64& random) {
    const SensorNoise noise;
    DarkLibrary darks;
    for (const DarkCapture& capture : plan.darks) {
        std::vector<Frame> frames;
        for (int i = 0; i < capture.frames; ++i)
            frames.push_back(darkPicture(capture.exposure, random));
        darks.add(averageDark(frames, noise).value());
    }
    std::vector<Frame> bracket;
    for (const ShotKind& pilot : plan.pilots) bracket.push_back(picture(state, pilot, random));
    for (const PlannedCapture& capture : plan.states[0].captures) {
        for (int i = 0; i < capture.frames; ++i)
            bracket.push_back(picture(state, capture.shot, random));
    }
    return merge(bracket, Band::G, darks, noise).value();
}

/// Of each option, pilots included.
StateFrames framesOf(const Plan& plan, const std::vector<ShotOption>& options) {
    StateFrames taken{.options = options, .frames = std::vector<int>(options.size(), 0)};
    for (std::size_t g = 0; g < options.size(); ++g) {
        for (const ShotKind& pilot : plan.pilots) taken.frames[g] += options[g].kind == pilot;
        for (const PlannedCapture& c : plan.states[0].captures)
            taken.frames[g] += options[g].kind == c.shot ? c.frames : 0;
    }
    return taken;
}

struct Case {
    std::size_t material;
    int levels;
    bool usb3;
    double wanted;
};

class Achieved : public testing::TestWithParam<Case> {};

TEST_P(Achieved, IsWhatWasPlannedWithinTenPerCent) {
    const Case& c = GetParam();
    constexpr std::uint64_t kSeed = 11;
    std::mt19937_64 random(kSeed);
    test::SmallScene scene = test::smallScene(
        c.material, c.levels, c.usb3 ? RigTiming::usb3() : RigTiming::usb2(), kCells);
    for (PlanCell& cell : scene.states[0].cells) cell.pixels = kPixels;
    const Result<Plan> plan = planCaptures(scene.input(), {.wanted = c.wanted});
    ASSERT_TRUE(plan);
    const MergedState merged = carriedOut(*plan, scene.states[0], random);
    const std::vector<ShotOption> options = shotOptions(scene.rig, plan->darkFrames);
    const StateFrames taken = framesOf(*plan, options);
    double squares = 0, worst = 0;
    for (int y = 0; y < kCells; ++y) {
        const PlanCell& cell = scene.states[0].cells[static_cast<std::size_t>(y)];
        double mean = 0;
        for (const float x : merged.radiance.row(y)) mean += static_cast<double>(x) / kPixels;
        const double z = (mean / cell.rate - 1) / randomUncertainty(cell, taken);
        ASSERT_TRUE(std::isfinite(z)) << "seed " << kSeed << " cell " << y;
        squares += z * z;
        worst = std::max(worst, std::abs(z));
    }
    // The rms of 600 Gaussian numbers of unit size is 1 +- 0.029.
    EXPECT_NEAR(std::sqrt(squares / kCells), 1, 0.10) << "seed " << kSeed;
    EXPECT_LT(worst, 5);
}

std::vector<Case> cases() {
    std::vector<Case> all;
    for (std::size_t material : {0U, 1U, 2U, 3U}) {
        for (int levels : {1, 2, 3}) {
            for (bool usb3 : {false, true})
                all.push_back({material, levels, usb3, levels == 1 ? 0.10 : 0.02});
        }
    }
    return all;
}
INSTANTIATE_TEST_SUITE_P(MaterialsLevelsRigs, Achieved, testing::ValuesIn(cases()));

}  // namespace
