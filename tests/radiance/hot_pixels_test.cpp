// Pixels with a dark current of their own, from the dark frames to the merged picture.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "proc/radiance/merge.h"
#include "tests/radiance/frames.h"

namespace {

using namespace gonio;
using namespace gonio::proc;
using gonio::test::Hot;
using gonio::test::take;

constexpr Size kSize{256, 256};
constexpr int kDarks = 4;
const std::vector<double> kSeconds{20e-6, 80e-6, 320e-6, 1280e-6, 5120e-6, 40e-3};

/// One sensor: `count` hot pixels of 30 to 3000 electrons per second, as many in each octave.
std::vector<Hot> drawn(int count, std::mt19937_64& random) {
    std::uniform_int_distribution<int> at(0, kSize.width - 1);
    std::uniform_real_distribution<double> decades(std::log10(30.0), std::log10(3000.0));
    std::vector<Hot> hot;
    while (static_cast<int>(hot.size()) < count) {
        const Hot next{at(random), at(random), std::pow(10, decades(random))};
        const bool taken = std::any_of(
            hot.begin(), hot.end(), [&](const Hot& h) { return h.x == next.x && h.y == next.y; });
        if (!taken) hot.push_back(next);
    }
    return hot;
}

std::vector<Frame> darkFrames(double seconds,
                              const std::vector<Hot>& hot,
                              std::mt19937_64& random,
                              int count = kDarks) {
    std::vector<Frame> frames;
    for (int i = 0; i < count; ++i)
        frames.push_back(take({.seconds = seconds, .level = 0}, kSize, random, hot));
    return frames;
}

DarkLibrary darkLibrary(const std::vector<Hot>& hot, std::mt19937_64& random) {
    DarkLibrary library;
    for (const double seconds : kSeconds)
        library.add(*averageDark(darkFrames(seconds, hot, random), {}));
    return library;
}

std::vector<Frame> bracket(double light, const std::vector<Hot>& hot, std::mt19937_64& random) {
    std::vector<Frame> frames;
    for (const double seconds : kSeconds)
        frames.push_back(
            take({.electronsPerSecond = light, .seconds = seconds}, kSize, random, hot));
    return frames;
}

TEST(HotPixels, AreThoseThatStandFiveSigmaAboveTheAverage) {
    std::mt19937_64 random(3);
    // 12 electrons in 40 ms are 8 sigma of the mean of four frames, 2 are 1.3.
    const std::vector<Hot> hot{{.x = 200, .y = 7, .electronsPerSecond = 3000},
                               {.x = 9, .y = 7, .electronsPerSecond = 300},
                               {.x = 9, .y = 8, .electronsPerSecond = 50}};
    const auto dark = averageDark(darkFrames(40e-3, hot, random), {});
    ASSERT_TRUE(dark);
    ASSERT_EQ(dark->hot.size(), 2U);
    ASSERT_EQ(dark->hotInRow(7).size(), 2U);
    EXPECT_TRUE(dark->hotInRow(8).empty());
    EXPECT_EQ(dark->hot[0].x, 9);  // from left to right
    EXPECT_EQ(dark->hot[1].x, 200);
    // 120 electrons less the others' 0.12: known to sqrt(126 / 4).
    EXPECT_NEAR(dark->hot[1].excessDn * 2.6, 120, 4 * 5.7);
}

TEST(HotPixels, OneSingleDarkFrameShowsThemToo) {
    std::mt19937_64 random(3);
    const std::vector<Hot> hot{{.x = 200, .y = 7, .electronsPerSecond = 3000}};
    const auto dark = averageDark(darkFrames(40e-3, hot, random, 1), {});
    ASSERT_TRUE(dark);
    ASSERT_EQ(dark->hotInRow(7).size(), 1U);
    EXPECT_EQ(dark->hotInRow(7)[0].x, 200);
}

TEST(HotPixels, OneNormalPixelInAMillionIsTakenForOne) {
    std::mt19937_64 random(4);
    std::size_t hot = 0;
    for (int i = 0; i < 3; ++i) {
        for (const double seconds : kSeconds)
            hot += averageDark(darkFrames(seconds, {}, random), {})->hot.size();
    }
    EXPECT_LE(hot, 5U);  // of 1.2 million
    // Nor where there is no noise at all.
    std::vector<Frame> same = darkFrames(1e-3, {}, random, 2);
    for (Frame& frame : same)
        for (auto& pixel : frame.pixels.pixels()) pixel = 61;
    EXPECT_TRUE(averageDark(same, {})->hot.empty());
}

TEST(HotPixels, ThePooledVarianceLeavesThemOut) {
    std::mt19937_64 random(5);
    const std::vector<Hot> hot = drawn(400, random);
    const auto frames = darkFrames(40e-3, hot, random);
    const auto dark = averageDark(frames, {});
    ASSERT_TRUE(dark);
    const double model = SensorNoise().darkVariance(40e-3) / (2.6 * 2.6);
    // 3 x 65,000 degrees of freedom: 0.3 %. With the hot pixels it would be 2 % more.
    EXPECT_NEAR(dark->varianceOfMean * kDarks / model, 1, 0.01);
}

/// How far hot pixels are from the truth, in units of their own uncertainty.
struct Pulls {
    double squares = 0, sum = 0, within2 = 0, count = 0;
    void add(double pull) {
        squares += pull * pull;
        sum += pull;
        within2 += std::abs(pull) <= 2 ? 1 : 0;
        ++count;
    }
};

Pulls pulls(double light, int repeats, std::mt19937_64& random) {
    Pulls all;
    for (int i = 0; i < repeats; ++i) {
        const std::vector<Hot> hot = drawn(260, random);  // 0.4 %
        const DarkLibrary darks = darkLibrary(hot, random);
        const auto state = merge(bracket(light, hot, random), Band::G, darks, {});
        EXPECT_TRUE(state);
        for (const Hot& h : hot) {
            const double error = static_cast<double>(state->radiance.at(h.x, h.y)) - light;
            all.add(error / std::sqrt(static_cast<double>(state->variance.at(h.x, h.y))));
        }
    }
    return all;
}

TEST(HotPixels, TheirUncertaintyHoldsTheirErrors) {
    // 20 electrons of light at 40 ms, as many as the dark current, and far more.
    std::mt19937_64 random(6);
    for (const double light : {500.0, 5e3, 1e5}) {
        const Pulls p = pulls(light, 6, random);
        // 1560 pixels: sigma of the share is 0.5 %, of the mean square 3.6 %. The dark current that
        // stays unseen, below 7 electrons, makes the dimmest up to 5 % worse.
        EXPECT_GT(p.within2 / p.count, 0.935) << light;
        EXPECT_LT(p.within2 / p.count, 0.972) << light;
        EXPECT_NEAR(p.squares / p.count, 1, 0.15) << light;
        EXPECT_LT(std::abs(p.sum) / p.count, 4 / std::sqrt(p.count)) << light;
    }
}

TEST(HotPixels, ChiSquareStaysOne) {
    std::mt19937_64 random(8);
    const std::vector<Hot> hot = drawn(130, random);
    const auto state = merge(bracket(500, hot, random), Band::G, darkLibrary(hot, random), {});
    ASSERT_TRUE(state);
    // 5 x 65,536 degrees of freedom: 0.25 %. Without its own variance each hot pixel adds 5.
    EXPECT_NEAR(state->chiSquare / static_cast<double>(state->freedom), 1, 0.01);
}

TEST(HotPixels, ANormalPixelsResultIsTheSameBits) {
    std::mt19937_64 random(9);
    const std::vector<Hot> hot = drawn(130, random);
    DarkLibrary darks, blind;
    for (const double seconds : kSeconds) {
        DarkFrame dark = *averageDark(darkFrames(seconds, hot, random), {});
        darks.add(dark);
        dark.hot.clear();
        blind.add(dark);
    }
    const auto frames = bracket(5e3, hot, random);
    const auto seen = merge(frames, Band::G, darks, {});
    const auto unseen = merge(frames, Band::G, blind, {});
    ASSERT_TRUE(seen && unseen);
    int differ = 0;
    for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < kSize.width; ++x) {
            if (seen->radiance.at(x, y) == unseen->radiance.at(x, y) &&
                seen->variance.at(x, y) == unseen->variance.at(x, y))
                continue;
            ++differ;
            EXPECT_TRUE(std::any_of(
                hot.begin(), hot.end(), [&](const Hot& h) { return h.x == x && h.y == y; }));
            EXPECT_GT(seen->variance.at(x, y), unseen->variance.at(x, y));
        }
    }
    EXPECT_GT(differ, 50);
}

TEST(HotPixels, MergeMatchesReference) {
    std::mt19937_64 random(10);
    std::vector<Hot> hot = drawn(100, random);
    hot.push_back({.x = 0, .y = 0, .electronsPerSecond = 2.5e5});  // full in the dark at 40 ms
    const DarkLibrary darks = darkLibrary(hot, random);
    const auto frames = bracket(2e5, hot, random);
    const auto fast = merge(frames, Band::G, darks, {});
    const auto slow = mergeReference(frames, Band::G, darks, {});
    ASSERT_TRUE(fast && slow);
    EXPECT_EQ(fast->used, slow->used);
    for (std::size_t i = 0; i < fast->radiance.pixels().size(); ++i) {
        ASSERT_NEAR(fast->radiance.pixels()[i] / slow->radiance.pixels()[i], 1, 1e-6);
        ASSERT_NEAR(fast->variance.pixels()[i] / slow->variance.pixels()[i], 1, 1e-6);
    }
}

TEST(HotPixels, BinnedOnesHaveTheNoiseOfAMean) {
    std::mt19937_64 random(11);
    Frame frame = take({.electronsPerSecond = 1e6}, kSize, random);
    DarkFrame dark{.mean = Image<float>(kSize, 60),
                   .varianceOfMean = 0.1,
                   .hot = {{.x = 3, .y = 2, .excessDn = 50}},
                   .exposure = frame.exposure,
                   .window = {.size = kSize, .binning = 2},
                   .frames = 4};
    frame.window = dark.window;
    DarkLibrary darks;
    darks.add(dark);
    const auto state = merge(std::vector{frame}, Band::G, darks, {});
    ASSERT_TRUE(state);
    // Four members share an excess of 4 x 130 electrons: its variance is that over 16; and again
    // a quarter of it for the mean of four dark frames.
    const double x = static_cast<double>(state->radiance.at(3, 2));
    const double single = (x * 1e-3 + 2.4 * 2.4 + 3e-3 + 130) / 4 + 2.6 * 2.6 / 12;
    const double ofDark = 0.1 * 2.6 * 2.6 + 130 / 4.0 / 4;
    EXPECT_NEAR(state->variance.at(3, 2) / ((single + ofDark) * 1e6), 1, 1e-5);
}

TEST(HotPixels, OneThatIsFullInTheDarkIsNotUsedAtThatExposure) {
    std::mt19937_64 random(12);
    // 12,000 electrons in 40 ms; 1,536 in 5 ms.
    const std::vector<Hot> hot{{.x = 5, .y = 5, .electronsPerSecond = 3e5}};
    const DarkLibrary darks = darkLibrary(hot, random);
    const auto state = merge(bracket(1000, hot, random), Band::G, darks, {});
    ASSERT_TRUE(state);
    EXPECT_EQ(state->used.at(5, 5), kSeconds.size() - 1);
    EXPECT_EQ(state->saturated.at(5, 5), 1);
    EXPECT_EQ(state->used.at(50, 50), kSeconds.size());
    const double sigma = std::sqrt(static_cast<double>(state->variance.at(5, 5)));
    EXPECT_NEAR(state->radiance.at(5, 5), 1000, 4 * sigma);
}

TEST(HotPixels, NearFullScaleTheirOwnNoiseDoesNotDecide) {
    // 9,960 electrons of dark current and light at 40 ms: 3,890 DN, where the mask begins. Over
    // many draws what is left is unbiased.
    std::mt19937_64 random(13);
    std::vector<Hot> hot;
    for (int y = 8; y < 256; y += 16)
        for (int x = 8; x < 256; x += 16)
            hot.push_back({.x = x, .y = y, .electronsPerSecond = 9960 / 40e-3 - 500});
    const DarkLibrary darks = darkLibrary(hot, random);
    Pulls all;
    for (int i = 0; i < 4; ++i) {
        const auto state = merge(bracket(500, hot, random), Band::G, darks, {});
        ASSERT_TRUE(state);
        for (const Hot& h : hot) {
            const double sigma = std::sqrt(static_cast<double>(state->variance.at(h.x, h.y)));
            all.add((static_cast<double>(state->radiance.at(h.x, h.y)) - 500) / sigma);
        }
    }
    // 256 dark means, each used four times: 256 independent errors at the least.
    EXPECT_LT(std::abs(all.sum / all.count), 4 / std::sqrt(256.0));
    EXPECT_NEAR(all.squares / all.count, 1, 0.2);
}

}  // namespace
