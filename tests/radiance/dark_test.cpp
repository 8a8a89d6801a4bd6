#include "proc/radiance/dark.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/radiance/frames.h"

namespace {

using namespace gonio;
using namespace gonio::proc;
using gonio::test::take;

constexpr Size kSize{64, 64};

std::vector<Frame> darks(int count, double seconds = 1e-3) {
    std::mt19937_64 random(1);
    std::vector<Frame> frames;
    for (int i = 0; i < count; ++i)
        frames.push_back(take({.seconds = seconds, .level = 0}, kSize, random));
    return frames;
}

TEST(DarkFrame, IsTheMeanOfItsFrames) {
    std::vector<Frame> frames = darks(2);
    for (auto& p : frames[0].pixels.pixels()) p = 60;
    for (auto& p : frames[1].pixels.pixels()) p = 63;
    const Result<DarkFrame> dark = averageDark(frames, {});
    ASSERT_TRUE(dark);
    EXPECT_EQ(dark->frames, 2);
    EXPECT_FLOAT_EQ(dark->mean.at(3, 5), 61.5F);
    EXPECT_DOUBLE_EQ(dark->varianceOfMean, 4.5 / 2);  // (1.5^2 + 1.5^2) / (2 - 1) / 2
}

TEST(DarkFrame, VarianceOfTheMeanIsThatOfTheNoiseModel) {
    const SensorNoise noise;
    const double model = noise.darkVariance(1e-3) / (noise.electronsPerDn * noise.electronsPerDn);
    const Result<DarkFrame> many = averageDark(darks(16), noise);
    ASSERT_TRUE(many);
    // 15 * 4096 degrees of freedom: relative sigma 0.6 %.
    EXPECT_NEAR(many->varianceOfMean * 16 / model, 1, 0.03);
    const Result<DarkFrame> one = averageDark(darks(1), noise);
    ASSERT_TRUE(one);
    EXPECT_DOUBLE_EQ(one->varianceOfMean, model);
}

TEST(DarkFrame, RefusesWhatIsNotDarkOrNotAlike) {
    EXPECT_EQ(averageDark({}, {}).error().kind, ErrorKind::Quality);
    std::vector<Frame> frames = darks(2);
    frames[1].led = 2;
    frames[1].levels = LedLevels::only(Band::R, 100);
    EXPECT_NE(averageDark(frames, {}).error().message.find("LED 2 lit"), std::string::npos);
    frames = darks(2);
    frames[1].exposure.granted += Nanoseconds(1);
    EXPECT_FALSE(averageDark(frames, {}));
    frames = darks(2);
    frames[1].window.x = 8;
    EXPECT_FALSE(averageDark(frames, {}));
    frames = darks(2);
    frames[1].gainDb = 6;
    EXPECT_FALSE(averageDark(frames, {}));
}

TEST(DarkLibrary, FindsByTheGrantedExposureExactly) {
    DarkLibrary library;
    library.add(*averageDark(darks(2, 1e-3), {}));
    library.add(*averageDark(darks(2, 2e-3), {}));
    library.add(*averageDark(darks(4, 2e-3), {}));  // replaces
    EXPECT_EQ(library.size(), 2U);
    const Frame frame = darks(1, 2e-3).front();
    const Result<const DarkFrame*> found = library.find(frame);
    ASSERT_TRUE(found);
    EXPECT_EQ((*found)->frames, 4);
    Frame other = frame;
    other.exposure.granted += Nanoseconds(1000);
    EXPECT_NE(library.find(other).error().message.find("2001.00 us"), std::string::npos);
    other = frame;
    other.window.y = 4;
    EXPECT_FALSE(library.find(other));
    other = frame;
    other.gainDb = 6;
    EXPECT_FALSE(library.find(other));
    EXPECT_EQ(DarkLibrary().find(frame).error().kind, ErrorKind::Quality);
}

}  // namespace
