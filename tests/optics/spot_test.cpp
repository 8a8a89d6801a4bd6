#include "proc/optics/spot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace gonio::proc {
namespace {

constexpr double kPeak = 4e8;  // electrons per second

/// A merged picture with an even background and its noise.
MergedState scene(double background = 1e4, int binning = 1) {
    const Size size{512 / binning, 512 / binning};
    MergedState state;
    state.radiance = Image<float>(size, static_cast<float>(background));
    state.variance = Image<float>(size, 1e12F);  // (1e6)^2: the noise of one short frame
    state.window = {.x = 128, .y = 40, .size = {512, 512}, .binning = binning};
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, 1e6);
    for (float& pixel : state.radiance.pixels()) pixel += static_cast<float>(noise(random));
    return state;
}

/// A disc, its edge pixels shared by 8 x 8 points. Centre and radius in pixels of the picture.
void addDisc(MergedState& state, double cx, double cy, double radius) {
    for (int y = 0; y < state.radiance.height(); ++y) {
        for (int x = 0; x < state.radiance.width(); ++x) {
            if (std::hypot(x + 0.5 - cx, y + 0.5 - cy) > radius + 2) continue;
            int inside = 0;
            for (int j = 0; j < 8; ++j) {
                for (int i = 0; i < 8; ++i) {
                    inside += std::hypot(x + (i + 0.5) / 8 - cx, y + (j + 0.5) / 8 - cy) <= radius;
                }
            }
            state.radiance.at(x, y) += static_cast<float>(kPeak * inside / 64);
        }
    }
}

TEST(Spot, IsFoundToAFewHundredthsOfAPixel) {
    for (const auto& [x, y] : {std::pair{200.0, 200.0}, {200.37, 143.81}, {33.5, 480.12}}) {
        MergedState state = scene();
        addDisc(state, x, y, 3.3);
        const auto spot = findSpot(state);
        ASSERT_TRUE(spot) << spot.error().message;
        EXPECT_NEAR(spot->at.x, 128 + x, 0.04);
        EXPECT_NEAR(spot->at.y, 40 + y, 0.04);
        EXPECT_GE(spot->sigma, 0.02);
        EXPECT_LT(spot->sigma, 0.05);
    }
}

TEST(Spot, StandsInSensorPixelsWhateverTheBinning) {
    MergedState state = scene(1e4, 2);
    addDisc(state, 100.2, 61.7, 1.7);
    const auto spot = findSpot(state);
    ASSERT_TRUE(spot) << spot.error().message;
    EXPECT_NEAR(spot->at.x, 128 + 200.4, 0.15);
    EXPECT_NEAR(spot->at.y, 40 + 123.4, 0.15);
}

TEST(Spot, IgnoresOneHotPixel) {
    MergedState state = scene();
    addDisc(state, 200, 200, 3.3);
    state.radiance.at(50, 60) = static_cast<float>(kPeak);
    const auto spot = findSpot(state);
    ASSERT_TRUE(spot) << spot.error().message;
    EXPECT_NEAR(spot->at.x, 328, 0.3);
}

std::string refusal(const MergedState& state) {
    const auto spot = findSpot(state);
    if (spot) return "found";
    EXPECT_EQ(spot.error().kind, ErrorKind::Quality);
    return spot.error().message;
}

TEST(Spot, SaysWhyThereIsNone) {
    EXPECT_NE(refusal(scene(1e7)).find("no bright spot"), std::string::npos);

    MergedState two = scene();
    addDisc(two, 200, 200, 3.3);
    addDisc(two, 300, 200, 3.3);
    EXPECT_NE(refusal(two).find("more than one"), std::string::npos);

    MergedState large = scene();
    addDisc(large, 200, 200, 20);
    EXPECT_NE(refusal(large).find("too large"), std::string::npos);

    MergedState saturated = scene();
    addDisc(saturated, 200, 200, 3.3);
    saturated.allSaturatedPixels = 12;
    EXPECT_NE(refusal(saturated).find("saturated"), std::string::npos);

    EXPECT_NE(refusal(MergedState{}).find("too small"), std::string::npos);
}

}  // namespace
}  // namespace gonio::proc
