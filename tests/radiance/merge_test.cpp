#include "proc/radiance/merge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/radiance/frames.h"

namespace {

using namespace gonio;
using namespace gonio::proc;
using gonio::test::cramerRao;
using gonio::test::perfectDarks;
using gonio::test::Shot;
using gonio::test::take;

constexpr Size kSize{96, 92};  // 8832 pixels, as in the study that set the limits

std::vector<Frame> bracketOf(std::vector<Shot> shots, double light, std::mt19937_64& random) {
    std::vector<Frame> frames;
    for (Shot& shot : shots) {
        shot.electronsPerSecond = light;
        frames.push_back(take(shot, kSize, random));
    }
    return frames;
}

/// Six exposures 20 us .. 40 ms and two dimmed ones of the shortest.
std::vector<Shot> ladder() {
    std::vector<Shot> shots;
    for (double us : {20.0, 80.0, 320.0, 1280.0, 5120.0, 40000.0})
        shots.push_back({.seconds = us * 1e-6});
    shots.push_back({.seconds = 20e-6, .level = 3277});
    shots.push_back({.seconds = 20e-6, .level = 164});
    return shots;
}

struct Moments {
    double mean = 0, rms = 0, meanVariance = 0;
};

Moments moments(const MergedState& state, double truth) {
    Moments m;
    const auto n = static_cast<double>(state.radiance.pixels().size());
    for (std::size_t i = 0; i < state.radiance.pixels().size(); ++i) {
        const double x = static_cast<double>(state.radiance.pixels()[i]);
        m.mean += x / n;
        m.rms += (x - truth) * (x - truth) / n;
        m.meanVariance += static_cast<double>(state.variance.pixels()[i]) / n;
    }
    m.rms = std::sqrt(m.rms);
    return m;
}

TEST(Merge, IsUnbiasedAndNearTheCramerRaoBound) {
    const std::vector<Shot> shots = ladder();
    const DarkLibrary darks = perfectDarks(shots, kSize);
    std::mt19937_64 random(7);
    // 420 to 2e10 electrons per second, chosen off and on the borders of saturation.
    for (double light = 420; light < 3e10; light *= 5.7) {
        const Result<MergedState> state =
            merge(bracketOf(shots, light, random), Band::G, darks, {});
        ASSERT_TRUE(state);
        const double bound = std::sqrt(cramerRao(shots, light));
        const Moments m = moments(*state, light);
        const double ofTheMean = bound / std::sqrt(8832.0);
        EXPECT_LT(std::abs(m.mean / light - 1), 0.0015 + 3 * ofTheMean / light) << light;
        // At a border of saturation the bound itself is ambiguous by the share of masked samples.
        EXPECT_LT(m.rms, 1.1 * bound) << light;
        EXPECT_NEAR(std::sqrt(m.meanVariance) / m.rms, 1, 0.05) << light;
    }
}

TEST(Merge, MatchesReference) {
    std::vector<Shot> shots = ladder();
    shots.insert(shots.end(), 3, {.seconds = 5120e-6});  // groups of several frames
    std::mt19937_64 random(11);
    std::vector<Frame> darkFrames;
    DarkLibrary darks;
    for (const Shot& shot : ladder()) {
        if (shot.level != 65535) continue;
        darkFrames.clear();
        for (int i = 0; i < 4; ++i)
            darkFrames.push_back(take({.seconds = shot.seconds, .level = 0}, kSize, random));
        darks.add(*averageDark(darkFrames, {}));
    }
    for (double light : {0.0, 1e4, 1.9e6, 3e9, 1e13}) {
        const std::vector<Frame> bracket = bracketOf(shots, light, random);
        const Result<MergedState> fast = merge(bracket, Band::G, darks, {});
        const Result<MergedState> slow = mergeReference(bracket, Band::G, darks, {});
        ASSERT_TRUE(fast && slow);
        EXPECT_EQ(fast->used, slow->used);
        EXPECT_EQ(fast->saturated, slow->saturated);
        EXPECT_EQ(fast->allSaturatedPixels, slow->allSaturatedPixels);
        EXPECT_EQ(fast->freedom, slow->freedom);
        EXPECT_NEAR(fast->chiSquare, slow->chiSquare, 1e-6 * slow->chiSquare + 1e-9);
        for (std::size_t i = 0; i < fast->radiance.pixels().size(); ++i) {
            const float a = fast->radiance.pixels()[i];
            const float b = slow->radiance.pixels()[i];
            ASSERT_EQ(std::isnan(a), std::isnan(b));
            if (std::isnan(a)) continue;
            const float sigma = std::sqrt(slow->variance.pixels()[i]);
            ASSERT_NEAR(a, b, 2e-7F * std::abs(b) + 1e-6F * sigma);  // one rounding to float
            ASSERT_NEAR(fast->variance.pixels()[i] / slow->variance.pixels()[i], 1, 1e-6);
        }
    }
}

TEST(Merge, MatchesReferenceWithANonLinearSensor) {
    // 2 % of curvature; rows longer than a block and not a multiple of it.
    const Linearity linearity{
        .blackDn = 60, .rangeDn = 4000, .coefficients = {0.004, 0.02, -0.004}};
    const Size size{301, 20};
    const std::vector<Shot> shots = ladder();
    std::mt19937_64 random(12);
    for (const double light : {1e4, 1.9e6, 3e9}) {
        std::vector<Frame> bracket;
        for (Shot shot : shots) {
            shot.electronsPerSecond = light;
            for (int i = 0; i < 3; ++i) bracket.push_back(take(shot, size, random));
        }
        const DarkLibrary darks = perfectDarks(shots, size);
        const auto fast = merge(bracket, Band::G, darks, {}, linearity);
        const auto slow = mergeReference(bracket, Band::G, darks, {}, linearity);
        const auto without = merge(bracket, Band::G, darks, {});
        ASSERT_TRUE(fast && slow && without);
        double moved = 0;
        for (std::size_t i = 0; i < fast->radiance.pixels().size(); ++i) {
            const float a = fast->radiance.pixels()[i];
            const float b = slow->radiance.pixels()[i];
            // The mean of three samples instead of each: c'' s^2 / 2 with c'' = 0.04 / 4000 is 2e-4
            // of the noise at s = 40 DN, and less below; three samples can differ by 3 s.
            const float sigma = std::sqrt(slow->variance.pixels()[i]);
            ASSERT_NEAR(a, b, 2e-7F * std::abs(b) + 2e-3F * sigma) << light;
            moved = std::max(moved, std::abs(double{without->radiance.pixels()[i] / b} - 1));
        }
        EXPECT_GT(moved, 1e-3) << light;
    }
}

TEST(Merge, MasksSaturatedPixels) {
    const std::vector<Shot> shots{{.seconds = 1e-3}, {.seconds = 10e-3}};
    std::mt19937_64 random(3);
    std::vector<Frame> bracket = bracketOf(shots, 4e6, random);  // 4000 and 40000 electrons
    const Result<MergedState> state = merge(bracket, Band::G, perfectDarks(shots, kSize), {});
    ASSERT_TRUE(state);
    EXPECT_EQ(state->used.at(5, 5), 1);
    EXPECT_EQ(state->saturated.at(5, 5), 1);
    EXPECT_EQ(state->allSaturatedPixels, 0U);
    EXPECT_NEAR(moments(*state, 4e6).mean / 4e6, 1, 0.001);
    EXPECT_EQ(state->freedom, 0U);
}

TEST(Merge, MaskedPixelIsNoNumber) {
    const std::vector<Shot> shots{{.seconds = 1e-3}};
    std::mt19937_64 random(3);
    std::vector<Frame> bracket = bracketOf(shots, 1e5, random);
    bracket[0].pixels.at(1, 0) = 4095;
    const Result<MergedState> state = merge(bracket, Band::G, perfectDarks(shots, kSize), {});
    ASSERT_TRUE(state);
    EXPECT_EQ(state->used.at(0, 0), 1);
    EXPECT_EQ(state->used.at(1, 0), 0);
    EXPECT_TRUE(std::isnan(state->radiance.at(1, 0)) && std::isnan(state->variance.at(1, 0)));
    EXPECT_EQ(state->allSaturatedPixels, 1U);
}

TEST(Merge, IsUnbiasedWhereTheMaskBegins) {
    // Eight frames of each of two exposures; the mean of the longer crosses 95 % of full scale. A
    // mask on the sample itself is wrong by 0.5 % here.
    std::vector<Shot> shots(8, {.seconds = 320e-6});
    shots.insert(shots.end(), 8, {.seconds = 1280e-6});
    const DarkLibrary darks = perfectDarks(shots, kSize);
    const SensorNoise noise;
    const double border = (noise.saturationDn() - test::kBlackDn) * noise.electronsPerDn / 1280e-6;
    std::mt19937_64 random(13);
    for (const double share : {0.97, 0.98, 0.99, 1.0, 1.01, 1.02, 1.03}) {
        const double light = share * border;
        const auto state = merge(bracketOf(shots, light, random), Band::G, darks, noise);
        ASSERT_TRUE(state);
        const Moments m = moments(*state, light);
        EXPECT_LT(std::abs(m.mean - light), 4 * m.rms / std::sqrt(8832.0)) << share;
    }
}

TEST(Merge, ZeroLightIsZeroOnAverageAndOfEitherSign) {
    const std::vector<Shot> shots = ladder();
    std::mt19937_64 random(5);
    const Result<MergedState> state =
        merge(bracketOf(shots, 0, random), Band::G, perfectDarks(shots, kSize), {});
    ASSERT_TRUE(state);
    const Moments m = moments(*state, 0);
    EXPECT_LT(std::abs(m.mean), 4 * m.rms / std::sqrt(8832.0));
    int negative = 0;
    for (float x : state->radiance.pixels()) negative += x < 0 ? 1 : 0;
    EXPECT_GT(negative, 8832 / 3);
}

TEST(Merge, OneFrameIsElectronsOverTime) {
    const std::vector<Shot> shots{{.seconds = 2e-3, .level = 6554}};
    std::mt19937_64 random(5);
    std::vector<Frame> bracket = bracketOf(shots, 1e6, random);
    bracket[0].pixels.at(4, 4) = 160;
    const Result<MergedState> state = merge(bracket, Band::G, perfectDarks(shots, kSize), {});
    ASSERT_TRUE(state);
    const double electrons = 100 * 2.6 - 3.0 * 2e-3;
    EXPECT_NEAR(state->radiance.at(4, 4), electrons / (2e-3 * 6554 / 65535), 0.2);
    EXPECT_EQ(state->led, 1);
    EXPECT_EQ(state->band, Band::G);
}

TEST(Merge, ChiSquareIsOneForNoiseAndSeesAnUnsteadyLed) {
    const std::vector<Shot> shots{{.seconds = 1e-3}, {.seconds = 2e-3}, {.seconds = 4e-3}};
    const DarkLibrary darks = perfectDarks(shots, kSize);
    std::mt19937_64 random(9);
    std::vector<Frame> bracket = bracketOf(shots, 1e6, random);
    const Result<MergedState> steady = merge(bracket, Band::G, darks, {});
    ASSERT_TRUE(steady);
    // 2 * 8832 degrees of freedom: sigma of chi^2 / freedom is 1.1 %.
    EXPECT_NEAR(steady->chiSquare / static_cast<double>(steady->freedom), 1, 0.05);
    bracket[2] = bracketOf({shots[2]}, 1.05e6, random)[0];
    const Result<MergedState> unsteady = merge(bracket, Band::G, darks, {});
    ASSERT_TRUE(unsteady);
    EXPECT_GT(unsteady->chiSquare / static_cast<double>(unsteady->freedom), 2);
}

TEST(Merge, BinnedPixelsHaveTheNoiseOfAMean) {
    const std::vector<Shot> shots{{.seconds = 1e-3}};
    std::mt19937_64 random(9);
    std::vector<Frame> bracket = bracketOf(shots, 1e6, random);
    DarkLibrary darks;
    DarkFrame dark = **perfectDarks(shots, kSize).find(bracket[0]);
    bracket[0].window.binning = dark.window.binning = 2;
    darks.add(dark);
    const Result<MergedState> state = merge(bracket, Band::G, darks, {});
    ASSERT_TRUE(state);
    const double x = static_cast<double>(state->radiance.at(0, 0));
    const double expected = (x * 1e-3 + 2.4 * 2.4 + 3e-3) / 4 + 2.6 * 2.6 / 12;
    EXPECT_NEAR(state->variance.at(0, 0) / (expected * 1e6), 1, 1e-5);
}

TEST(Merge, RefusesWhatIsNotOneState) {
    const std::vector<Shot> shots{{.seconds = 1e-3}, {.seconds = 2e-3}};
    const DarkLibrary darks = perfectDarks(shots, kSize);
    std::mt19937_64 random(9);
    const std::vector<Frame> good = bracketOf(shots, 1e5, random);
    const auto kind = [&](const std::vector<Frame>& frames, Band band) {
        const Result<MergedState> state = merge(frames, band, darks, {});
        return state ? ErrorKind::Internal : state.error().kind;
    };
    EXPECT_EQ(kind({}, Band::G), ErrorKind::Quality);
    EXPECT_EQ(kind(good, Band::R), ErrorKind::Quality);  // lit in G
    std::vector<Frame> bad = good;
    bad[1].led = 3;
    EXPECT_EQ(kind(bad, Band::G), ErrorKind::Quality);
    bad = good;
    bad[1].led.reset();
    EXPECT_EQ(kind(bad, Band::G), ErrorKind::Quality);
    bad = good;
    bad[1].levels.value = {5, 5, 0};
    EXPECT_EQ(kind(bad, Band::G), ErrorKind::Quality);
    bad = good;
    bad[1].window.x = 16;
    EXPECT_EQ(kind(bad, Band::G), ErrorKind::Quality);
    bad = good;
    bad[1].gainDb = 3;
    EXPECT_EQ(kind(bad, Band::G), ErrorKind::Quality);
    bad = good;
    bad[0].exposure.granted = Nanoseconds(12345);  // no dark frame of it
    EXPECT_EQ(kind(bad, Band::G), ErrorKind::Quality);
    EXPECT_FALSE(mergeReference(bad, Band::G, darks, {}));
}

}  // namespace
