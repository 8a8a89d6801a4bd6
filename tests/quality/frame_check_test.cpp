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
