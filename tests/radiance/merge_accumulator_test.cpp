#include "proc/radiance/merge_accumulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "proc/radiance/merge.h"
#include "proc/radiance/merge_blocks.h"
#include "tests/radiance/frames.h"

namespace gonio::proc {
namespace {

using test::perfectDarks;
using test::Shot;
using test::take;

constexpr Size kSize{140, 30};
const std::vector<Shot> kShots{{.electronsPerSecond = 2e6, .seconds = 20e-6},
                               {.electronsPerSecond = 2e6, .seconds = 320e-6},
                               {.electronsPerSecond = 2e6, .seconds = 5120e-6},
                               {.electronsPerSecond = 2e6, .seconds = 5120e-6},
                               {.electronsPerSecond = 2e6, .seconds = 20e-6, .level = 3277}};

std::vector<Frame> bracket() {
    std::mt19937_64 random(21);
    std::vector<Frame> frames;
    for (const Shot& shot : kShots) {
        frames.push_back(take(shot, kSize, random));
        frames.back().number = static_cast<std::uint32_t>(100 + frames.size());
    }
    return frames;
}

bool sameBits(const MergedState& a, const MergedState& b) {
    const auto same = [](float p, float q) { return p == q || (std::isnan(p) && std::isnan(q)); };
    return std::ranges::equal(a.radiance.pixels(), b.radiance.pixels(), same) &&
           std::ranges::equal(a.variance.pixels(), b.variance.pixels(), same) && a.used == b.used &&
           a.saturated == b.saturated && a.chiSquare == b.chiSquare && a.freedom == b.freedom;
}

TEST(MergeAccumulator, FramesOfAnyOrderThatAreLetGoOfGiveTheBitsOfTheBracket) {
    std::vector<Frame> frames = bracket();
    const DarkLibrary darks = perfectDarks(kShots, kSize);
    const auto whole = merge(frames, Band::G, darks, {});
    ASSERT_TRUE(whole);
    std::mt19937_64 random(3);
    for (int repeat = 0; repeat < 5; ++repeat) {
        std::shuffle(frames.begin(), frames.end(), random);
        MergeAccumulator accumulator(Band::G, darks, {});
        for (const Frame& frame : frames) {
            const Frame passing = frame;
            ASSERT_TRUE(accumulator.add(passing));
        }
        const auto streamed = mergeSums(accumulator.sums());
        ASSERT_TRUE(streamed);
        EXPECT_TRUE(sameBits(*streamed, *whole));
    }
}

TEST(MergeAccumulator, KeepsAWitnessOfEachFrameInTheirOrder) {
    const std::vector<Frame> frames = bracket();
    const DarkLibrary darks = perfectDarks(kShots, kSize);
    MergeAccumulator accumulator(Band::G, darks, {});
    for (const Frame& frame : frames) ASSERT_TRUE(accumulator.add(frame));
    const BracketSums& sums = accumulator.sums();
    ASSERT_EQ(sums.witnesses.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const Witness& witness = sums.witnesses[i];
        const GroupSums& group = sums.groups[witness.group];
        EXPECT_EQ(witness.number, frames[i].number);
        EXPECT_EQ(group.granted, frames[i].exposure.granted);
        EXPECT_EQ(group.level, frames[i].levels[Band::G]);
        ASSERT_EQ(witness.dn.size(), sums.grid.size.pixels());
        std::size_t at = 0;
        for (int y = 0; y < sums.grid.size.height; ++y) {
            for (int x = 0; x < sums.grid.size.width; ++x, ++at) {
                if (witness.dn[at] == Witness::kMasked) continue;
                ASSERT_EQ(witness.dn[at], frames[i].pixels.at(sums.grid.at(x), sums.grid.at(y)));
            }
        }
    }
    // The longest exposures are saturated at all pixels, the others at none.
    const auto masked = [](const Witness& w) {
        return static_cast<double>(std::ranges::count(w.dn, Witness::kMasked)) /
               static_cast<double>(w.dn.size());
    };
    EXPECT_EQ(masked(sums.witnesses[1]), 0);
    EXPECT_EQ(masked(sums.witnesses[2]), 1);
}

TEST(MergeAccumulator, WitnessesLieInsideThePictureAndAreFew) {
    for (const Size size : {Size{1, 1},
                            Size{1, 1000},
                            Size{1000, 1},
                            Size{128, 128},
                            Size{129, 5},
                            Size{1023, 1024},
                            Size{1280, 1024}}) {
        const WitnessGrid grid = WitnessGrid::over(size);
        EXPECT_GE(grid.size.width, 1);
        EXPECT_GE(grid.size.height, 1);
        EXPECT_LE(std::max(grid.size.width, grid.size.height), 128);
        EXPECT_LT(grid.at(grid.size.width - 1), size.width);
        EXPECT_LT(grid.at(grid.size.height - 1), size.height);
        EXPECT_GE(grid.at(grid.size.width), size.width);
        EXPECT_GE(grid.at(grid.size.height), size.height);
    }
}

TEST(MergeAccumulator, HoldsFourBytesPerPixelAndGroupAndTheWitnesses) {
    const std::vector<Frame> frames = bracket();
    const DarkLibrary darks = perfectDarks(kShots, kSize);
    MergeAccumulator accumulator(Band::G, darks, {});
    EXPECT_EQ(accumulator.bytes(), 0U);
    for (const Frame& frame : frames) ASSERT_TRUE(accumulator.add(frame));
    const std::size_t witnesses = accumulator.sums().grid.size.pixels();
    EXPECT_EQ(accumulator.bytes(), 4 * kSize.pixels() * 4 + 2 * witnesses * frames.size());
}

TEST(MergeAccumulator, RestartsInTheMemoryThatItHas) {
    const std::vector<Frame> frames = bracket();
    const DarkLibrary darks = perfectDarks(kShots, kSize);
    MergeAccumulator accumulator(Band::G, darks, {});
    for (const Frame& frame : frames) ASSERT_TRUE(accumulator.add(frame));
    const auto first = mergeSums(accumulator.sums());
    const std::size_t bytes = accumulator.bytes();
    accumulator.restart(Band::G);
    EXPECT_FALSE(mergeSums(accumulator.sums()));
    for (const Frame& frame : frames) ASSERT_TRUE(accumulator.add(frame));
    EXPECT_EQ(accumulator.bytes(), bytes);
    const auto again = mergeSums(accumulator.sums());
    ASSERT_TRUE(first && again);
    EXPECT_TRUE(sameBits(*first, *again));
    // Another size does not fit the memory; another band is taken.
    accumulator.restart(Band::R);
    Frame small = frames.front();
    small.pixels = Image<std::uint16_t>({3, 3}, 100);
    small.levels = LedLevels::only(Band::R, 65535);
    EXPECT_FALSE(accumulator.add(small));  // the dark frame has another window
    small = frames.front();
    small.levels = LedLevels::only(Band::R, 65535);
    EXPECT_TRUE(accumulator.add(small));
}

TEST(MergeAccumulator, ARefusedFrameLeavesItAsItWas) {
    const std::vector<Frame> frames = bracket();
    const DarkLibrary darks = perfectDarks(kShots, kSize);
    MergeAccumulator accumulator(Band::G, darks, {});
    Frame bad = frames.front();
    bad.led.reset();
    EXPECT_FALSE(accumulator.add(bad));
    for (const Frame& frame : frames) {
        ASSERT_TRUE(accumulator.add(frame));
        bad = frame;
        bad.gainDb = 6;
        EXPECT_FALSE(accumulator.add(bad));
        bad = frame;
        bad.exposure.granted = Nanoseconds(777);  // no dark frame
        EXPECT_FALSE(accumulator.add(bad));
    }
    const auto state = mergeSums(accumulator.sums());
    const auto whole = merge(frames, Band::G, darks, {});
    ASSERT_TRUE(state && whole);
    EXPECT_TRUE(sameBits(*state, *whole));
    EXPECT_EQ(accumulator.sums().witnesses.size(), frames.size());
}

TEST(MergeAccumulator, TakesAsManyFramesAlikeAsItsSumsHold) {
    const SensorNoise wide{.fullScaleDn = 65535};
    const std::vector<Shot> shots{{.seconds = 1e-3}};
    const DarkLibrary darks = perfectDarks(shots, {4, 4});
    std::mt19937_64 random(1);
    Frame frame = take(shots[0], {4, 4}, random);
    for (auto& pixel : frame.pixels.pixels()) pixel = 62000;
    MergeAccumulator accumulator(Band::G, darks, wide);
    for (int i = 0; i < 64; ++i) ASSERT_TRUE(accumulator.add(frame)) << i;
    const Result<void> more = accumulator.add(frame);
    ASSERT_FALSE(more);
    EXPECT_EQ(more.error().kind, ErrorKind::Quality);
    EXPECT_NE(more.error().message.find("more than 64 frames"), std::string::npos);
    const auto state = mergeSums(accumulator.sums());
    ASSERT_TRUE(state);
    EXPECT_EQ(state->used.at(2, 2), 64);
    // (62000 - 60) DN of 2.6 electrons in 1 ms, less 3 e-/s of dark current.
    EXPECT_NEAR(state->radiance.at(2, 2) / (61940 * 2.6 / 1e-3 - 3), 1, 1e-6);
    // 12 bit: 1023 frames at the largest usable value.
    for (auto& pixel : frame.pixels.pixels()) pixel = 3890;
    MergeAccumulator narrow(Band::G, darks, {});
    for (int i = 0; i < 1023; ++i) ASSERT_TRUE(narrow.add(frame)) << i;
    EXPECT_FALSE(narrow.add(frame));
    const auto full = mergeSums(narrow.sums());
    ASSERT_TRUE(full);
    EXPECT_NEAR(full->radiance.at(1, 1) / (3830 * 2.6 / 1e-3 - 3), 1, 1e-6);
}

TEST(MergeBlocks, AddUsableMatchesReference) {
    std::mt19937 random(8);
    std::uniform_int_distribution<int> dn(0, 4095), coin(0, 1);
    for (const std::size_t width : {1U, 7U, 8U, 31U, 128U, 131U, 1024U}) {
        std::vector<std::uint16_t> row(width);
        std::vector<std::uint8_t> usable(width);
        std::vector<std::uint32_t> tallies(width);
        std::vector<int> count(width), sum(width);
        for (int frame = 0; frame < 50; ++frame) {
            for (std::size_t x = 0; x < width; ++x) {
                row[x] = static_cast<std::uint16_t>(dn(random));
                usable[x] = static_cast<std::uint8_t>(coin(random));
                if (usable[x] == 0) continue;
                ++count[x];
                sum[x] += row[x];
            }
            addUsable(row, usable, tallies);
        }
        for (std::size_t x = 0; x < width; ++x) {
            EXPECT_EQ(tallies[x] >> kSumBits, static_cast<std::uint32_t>(count[x]));
            EXPECT_EQ(tallies[x] & kLargestSum, static_cast<std::uint32_t>(sum[x]));
        }
    }
}

}  // namespace
}  // namespace gonio::proc
