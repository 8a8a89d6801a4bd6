#include "proc/quality/frame_check.h"

#include <gtest/gtest.h>

#include <random>

namespace gonio::proc {
namespace {

constexpr Size kSize{128, 128};
const SensorNoise kNoise;

/// A picture of so many electrons on average in each pixel above a black level of 60.
Frame picture(unsigned seed, double electrons) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(electrons, std::sqrt(kNoise.variance(electrons, 0.005)));
    Frame frame;
    frame.pixels = Image<std::uint16_t>(kSize);
    frame.exposure.granted = Nanoseconds(5'000'000);
    for (std::uint16_t& dn : frame.pixels.pixels()) {
        const double value = 60 + noise(random) / kNoise.electronsPerDn;
        dn = static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0, kNoise.fullScaleDn)));
    }
    return frame;
}

DarkFrame dark() { return {.mean = Image<float>(kSize, 60), .varianceOfMean = 0.2}; }

TEST(FrameCheck, TheSamePictureAgainIsRepeated) {
    const Frame first = picture(1, 500);
    EXPECT_TRUE(isRepeated(first, first, kNoise));
    EXPECT_TRUE(isRepeated(picture(1, 0), picture(1, 0), kNoise)) << "dark ones too";
    EXPECT_FALSE(isRepeated(picture(2, 500), first, kNoise));
    Frame other = first;
    other.pixels.at(64, 64) ^= 1;
    EXPECT_FALSE(isRepeated(other, first, kNoise)) << "one bit of one pixel";
}

TEST(FrameCheck, PicturesWithoutNoiseAreNotCalledRepeated) {
    const Frame saturated = picture(1, 1e6);
    EXPECT_FALSE(isRepeated(saturated, saturated, kNoise));
    Frame nearly = saturated;  // 999 pixels that tell
    for (std::size_t i = 0; i < 999; ++i) nearly.pixels.pixels()[i] = static_cast<std::uint16_t>(i);
    EXPECT_FALSE(isRepeated(nearly, nearly, kNoise));
    nearly.pixels.pixels()[999] = 7;
    EXPECT_TRUE(isRepeated(nearly, nearly, kNoise));
    EXPECT_FALSE(isRepeated({}, {}, kNoise));
}

TEST(FrameCheck, NoPictureIsOneWithoutNoise) {
    Frame blank = picture(1, 0);
    std::ranges::fill(blank.pixels.pixels(), std::uint16_t{60});
    EXPECT_TRUE(isBlank(blank, kNoise));
    EXPECT_FALSE(isBlank(picture(1, 0), kNoise)) << "a dark one has its noise";
    EXPECT_FALSE(isBlank(picture(1, 1e6), kNoise)) << "full scale hides it";
    const SensorNoise coarse{.electronsPerDn = 41.6, .fullScaleDn = 255};
    EXPECT_FALSE(isBlank(blank, coarse)) << "rounding hides it";
    EXPECT_FALSE(isRepeated(blank, blank, coarse));
}

/// `picture` as one of another exposure or level.
Frame shown(Frame frame, Microseconds exposure, std::uint16_t level = 65535) {
    frame.exposure.granted = exposure;
    frame.levels = LedLevels::only(Band::G, level);
    frame.blackLevel = 60;
    return frame;
}

Agreement agrees(const Frame& frame, const Frame& before, double uOfBlack = 0.5) {
    const BlackLevel black{.dn = 60, .u = uOfBlack};
    return agreement(
        {.frame = &frame, .black = black}, {.frame = &before, .black = black}, Band::G, kNoise);
}

TEST(FrameCheck, LightGoesWithTheExposure) {
    using namespace std::chrono_literals;
    const Frame before = shown(picture(1, 500), 1000us);
    EXPECT_EQ(agrees(shown(picture(2, 1000), 2000us), before), Agreement::Agrees);
    EXPECT_EQ(agrees(shown(picture(2, 500), 2000us), before), Agreement::Darker);
    EXPECT_EQ(agrees(shown(picture(2, 1000), 1000us), before), Agreement::Brighter);
    EXPECT_EQ(agrees(shown(picture(2, 0), 1000us), before), Agreement::Darker) << "unlit";
    EXPECT_EQ(agrees(shown(picture(2, 500), 40'000us), before), Agreement::Darker)
        << "all of it should be saturated";
    EXPECT_EQ(agrees(shown(picture(2, 20'000), 40'000us), before), Agreement::Agrees);
    EXPECT_EQ(agrees(shown(picture(2, 850), 34us), shown(picture(1, 500), 20us)),
              Agreement::Agrees);
    EXPECT_EQ(agrees(shown(picture(2, 850), 20us), shown(picture(1, 500), 20us)),
              Agreement::Brighter)
        << "a sensor adds the same to the same exposure";
    EXPECT_EQ(agrees(shown(picture(2, 0.4), 2000us), shown(picture(1, 0.1), 1000us)),
              Agreement::Agrees)
        << "too dark to tell";
    EXPECT_EQ(agrees(shown(picture(2, 500), 2000us, 30000), before), Agreement::Agrees)
        << "of another level light that leaks in may be most of it";
}

TEST(FrameCheck, AHigherLevelBringsMoreLight) {
    using namespace std::chrono_literals;
    constexpr std::uint16_t kDim = 164;
    const Frame dim = shown(picture(1, 100), 20us, kDim), full = shown(picture(2, 100), 20us);
    EXPECT_EQ(agrees(full, dim), Agreement::Agrees) << "all of it may come with any level";
    const Frame late = shown(picture(3, 5'000), 20us, kDim);  // really of the capture before
    EXPECT_EQ(agrees(full, late), Agreement::Darker);
    EXPECT_EQ(agrees(late, full), Agreement::Brighter);
    const Frame saturated = shown(picture(3, 1e6), 20us, kDim);
    EXPECT_EQ(agrees(full, saturated), Agreement::Darker);
    EXPECT_EQ(agrees(saturated, full), Agreement::Reflex);
    EXPECT_EQ(agrees(shown(picture(4, 1e6), 20us), saturated), Agreement::Agrees);
    EXPECT_EQ(agrees(shown(picture(4, 500), 1000us), shown(picture(5, 500), 1000us, kDim)),
              Agreement::Agrees)
        << "most of the light may come with any level";
    EXPECT_EQ(agrees(shown(picture(4, 250), 1000us), shown(picture(5, 500), 1000us, kDim)),
              Agreement::Darker);
    EXPECT_EQ(agrees(shown(picture(4, 0.1), 20us), shown(picture(5, 0.4), 20us, kDim)),
              Agreement::Agrees)
        << "too dark to tell";
}

TEST(FrameCheck, ADimPictureForetellsAsMuchAsItsBlackLevelIsKnown) {
    using namespace std::chrono_literals;
    const Frame dim = shown(picture(1, 1), 20us);  // 0.4 DN
    const Frame tooDark = shown(picture(2, 20), 5000us), sound = shown(picture(2, 500), 5000us);
    EXPECT_EQ(agrees(tooDark, dim), Agreement::Agrees) << "half a DN is most of it";
    EXPECT_EQ(agrees(tooDark, dim, 0.1), Agreement::Darker);
    EXPECT_EQ(agrees(sound, dim, 0.1), Agreement::Agrees);
}

TEST(FrameCheck, SaturationWhereItWasDimIsAReflex) {
    using namespace std::chrono_literals;
    const auto with = [](int side) {
        Frame frame = shown(picture(2, 1000), 2000us);
        for (int y = 40; y < 40 + side; ++y)
            for (int x = 40; x < 40 + side; ++x) frame.pixels.at(x, y) = 4095;
        return frame;
    };
    const Frame before = shown(picture(1, 500), 1000us);
    EXPECT_EQ(agrees(with(7), before), Agreement::Reflex);
    EXPECT_EQ(agrees(with(3), before), Agreement::Agrees) << "a particle's trace";
    const Frame dim = shown(picture(1, 100), 1000us, 6554);
    EXPECT_EQ(agrees(with(7), dim), Agreement::Reflex) << "of any level";
    const Frame bright = shown(picture(1, 6000), 1000us);
    EXPECT_EQ(agrees(shown(picture(2, 12'000), 2000us), bright), Agreement::Agrees)
        << "it was foretold";
}

TEST(FrameCheck, ALitFrameWithoutLightIsSeen) {
    // Noise of the mean of 128 x 128 pixels: sqrt(6.3 + 1.4) / 128 = 0.022 electrons.
    constexpr double kWhite = 5000;
    EXPECT_TRUE(showsNoLight(picture(1, 0), dark(), kWhite, kNoise));
    EXPECT_FALSE(showsNoLight(picture(1, 0.3), dark(), kWhite, kNoise)) << "a very black sample";
    EXPECT_FALSE(showsNoLight(picture(1, 500), dark(), kWhite, kNoise));
    EXPECT_FALSE(showsNoLight(picture(1, 0), dark(), 100, kNoise)) << "white is dim itself";
}

}  // namespace
}  // namespace gonio::proc
