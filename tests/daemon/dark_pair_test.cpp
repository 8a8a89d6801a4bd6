// The noise of two dark frames of the model sensor; on a rig, see doctor_rig_test.cpp.

#include "daemon/dark_pair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/radiance/frames.h"

namespace gonio::daemon {
namespace {

constexpr Size kSize{128, 128};
constexpr gonio::test::Shot kDark{.seconds = 1e-3, .level = 0};

class DarkPair : public testing::Test {
protected:
    driver::Capture pair(const std::vector<gonio::test::Hot>& hot = {}) {
        driver::Capture two;
        for (int i = 0; i < 2; ++i)
            two.frames.push_back(gonio::test::take(kDark, kSize, random, hot, noise));
        return two;
    }
    proc::SensorNoise noise;
    std::mt19937_64 random{5};
    /// Standard error of sigma by the differences of so many pixels.
    const double error = std::sqrt(0.5 / (kSize.width * kSize.height));
};

TEST_F(DarkPair, NoiseOfOneFrameIsWhatTheSensorsFiguresSay) {
    const driver::Capture dark = pair();
    const double wanted = expectedSigma(noise, dark.front());
    const DarkNoise seen = noiseOf(dark);
    EXPECT_NEAR(seen.sigma, wanted, 4 * error * wanted);
    EXPECT_NEAR(seen.mean, gonio::test::kBlackDn, 0.03);  // four standard errors, and 3e-3 e- / K
    EXPECT_NEAR(seen.step, 0, 0.05);                      // four standard errors
}

TEST_F(DarkPair, WhatBothFramesHaveIsNoNoise) {
    driver::Capture dark = pair();
    for (Frame& frame : dark.frames) {
        for (int x = 0; x < kSize.width; x += 2) frame.pixels.at(x, 7) += 500;
    }
    const double wanted = expectedSigma(noise, dark.front());
    EXPECT_NEAR(noiseOf(dark).sigma, wanted, 4 * error * wanted);
}

TEST_F(DarkPair, HotPixelsAreLeftOut) {
    std::vector<gonio::test::Hot> hot;
    for (int i = 0; i < 50; ++i) hot.push_back({.x = i, .y = i, .electronsPerSecond = 3e6});
    const driver::Capture dark = pair(hot);
    const double wanted = expectedSigma(noise, dark.front());
    EXPECT_NEAR(noiseOf(dark).sigma, wanted, 4 * error * wanted + 0.01);  // some hot ones agree
}

TEST_F(DarkPair, StepIsFromTheSecondFrameToTheFirst) {
    driver::Capture dark = pair();
    for (std::uint16_t& pixel : dark.frames[0].pixels.pixels())
        pixel = static_cast<std::uint16_t>(pixel + 3);
    EXPECT_NEAR(noiseOf(dark).step, 3, 0.05);
}

TEST_F(DarkPair, BinnedPixelIsTheMeanOfItsMembersAndRoundedOnce) {
    Frame frame = gonio::test::unexposed(kDark, kSize);
    noise = {.electronsPerDn = 2, .readNoiseElectrons = 4, .darkElectronsPerSecond = 0};
    EXPECT_NEAR(expectedSigma(noise, frame), std::sqrt(16 / 4.0 + 1 / 12.0), 1e-12);
    frame.window.binning = 2;
    EXPECT_NEAR(expectedSigma(noise, frame), std::sqrt(4 / 4.0 + 1 / 12.0), 1e-12);
}

}  // namespace
}  // namespace gonio::daemon
