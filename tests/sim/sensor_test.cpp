#include "sim/sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace gonio::sim {
namespace {

constexpr Size kSmall{400, 400};

TEST(Sensor, GrantsWholeLinesPlusItsOffset) {
    EXPECT_EQ(grantedExposure(20).count(), 5'500 + 14'260);
    const double granted = static_cast<double>(grantedExposure(1000).count()) * 1e-3;
    EXPECT_NEAR(granted, 1000, 2.75);
}

TEST(Sensor, SameKeySameFrameAnotherStepAnotherFrame) {
    const Sensor sensor("SIM-0001");
    const Image<float> rate(kSmall, 1e6F);
    const auto frame = [&](NoiseKey key) {
        return sensor.expose(&rate, 1, Nanoseconds(1'000'000), {.size = kSmall}, key, 1);
    };
    EXPECT_EQ(frame({1, 2, 0}), frame({1, 2, 0}));
    EXPECT_NE(frame({1, 2, 0}), frame({1, 3, 0}));
    EXPECT_NE(frame({1, 2, 0}), frame({1, 2, 1}));
    EXPECT_NE(frame({1, 2, 0}), frame({2, 2, 0}));
}

// Photon transfer: variance of the difference of two frames against the mean.
TEST(Sensor, PhotonTransferGivesGainAndReadNoise) {
    const Sensor sensor("SIM-0001");
    const auto pair = [&](float electrons, double& mean, double& variance) {
        const Image<float> rate(kSmall, electrons * 1e3F);
        const auto a =
            sensor.expose(&rate, 1, Nanoseconds(1'000'000), {.size = kSmall}, {1, 1, 0}, 1);
        const auto b =
            sensor.expose(&rate, 1, Nanoseconds(1'000'000), {.size = kSmall}, {1, 1, 1}, 1);
        double sum = 0, squares = 0;
        const auto n = static_cast<double>(a.pixels().size());
        for (std::size_t i = 0; i < a.pixels().size(); ++i) {
            const double d = double{1} * a.pixels()[i] - b.pixels()[i];
            sum += a.pixels()[i];
            squares += d * d;
        }
        mean = sum / n - kBlackLevel;
        variance = squares / n / 2;
    };
    double darkMean = 0, darkVariance = 0, mean = 0, variance = 0;
    pair(0, darkMean, darkVariance);
    pair(5000, mean, variance);
    // 160,000 pixels: the variance is known to 0.5 %.
    EXPECT_NEAR((mean - darkMean) / (variance - darkVariance), 2.6, 0.04);
    EXPECT_NEAR(std::sqrt(darkVariance - 1 / 12.0) * 2.6, 2.4, 0.05);
    EXPECT_NEAR(darkMean, 0, 0.02);
}

TEST(Sensor, SaturatesAtFullScale) {
    const Sensor sensor("SIM-0001");
    const Image<float> rate({8, 8}, 1e9F);
    const auto frame =
        sensor.expose(&rate, 1, Nanoseconds(1'000'000), {.size = {8, 8}}, {1, 1, 0}, 1);
    EXPECT_GE(frame.at(3, 3), kFullScale - 8);
}

TEST(Sensor, BinnedPixelIsTheMeanUnlessOneIsSaturated) {
    const Sensor sensor("SIM-0001");
    Image<float> rate({4, 4}, 1e6F);
    const auto full =
        sensor.expose(&rate, 1, Nanoseconds(1'000'000), {.size = {4, 4}}, {1, 1, 0}, 1);
    const auto binned =
        sensor.expose(&rate, 1, Nanoseconds(1'000'000), {.size = {4, 4}}, {1, 1, 0}, 2);
    const int sum = full.at(0, 0) + full.at(1, 0) + full.at(0, 1) + full.at(1, 1);
    EXPECT_EQ(binned.size(), (Size{2, 2}));
    EXPECT_EQ(binned.at(0, 0), (sum + 2) / 4);
}

TEST(Sensor, ResponsesScatterBySevenTenthsOfAPerCent) {
    const Sensor sensor("SIM-0001");
    double squares = 0;
    constexpr int kPixels = 20000;
    for (std::uint64_t i = 0; i < kPixels; ++i) squares += std::pow(sensor.response(i) - 1, 2);
    EXPECT_NEAR(std::sqrt(squares / kPixels), 0.007, 0.0002);
}

/// Mean DN above the black level of a dark exposure, over the hot pixels or over the others.
double darkDn(double celsius, Nanoseconds exposure, bool hot) {
    constexpr View kPart{.size = {256, 256}};
    const Sensor sensor("SIM-0001", celsius);
    const auto frame = sensor.expose(nullptr, 0, exposure, kPart, {1, 1, 0}, 1);
    double sum = 0;
    double count = 0;
    for (int y = 0; y < kPart.size.height; ++y) {
        for (int x = 0; x < kPart.size.width; ++x) {
            const int pixel = y * kSensorSize.width + x;
            if ((sensor.darkCurrent(static_cast<std::uint64_t>(pixel)) > kDarkAt25) != hot)
                continue;
            sum += frame.at(x, y) - kBlackLevel;
            ++count;
        }
    }
    return sum / count;
}

TEST(Sensor, DarkCurrentDoublesEachSevenKelvin) {
    // 60 and 120 electrons at 2.6 e-/DN; the mean of 65,536 pixels is known to 0.02 DN.
    constexpr Nanoseconds kExposure(20'000'000'000);
    EXPECT_NEAR(darkDn(25, kExposure, false), 60 / 2.6, 0.1);
    EXPECT_NEAR(darkDn(32, kExposure, false), 120 / 2.6, 0.1);
}

TEST(Sensor, HotPixelsDoubleEachSevenKelvinToo) {
    // A dozen of them with some 250 DN each: sqrt(12 x 250 / 2.6) = 34 DN of noise in 3000.
    constexpr Nanoseconds kExposure(1'000'000'000);
    const double at25 = darkDn(25, kExposure, true);
    EXPECT_GT(at25, 30 / 2.6);
    EXPECT_NEAR(darkDn(32, kExposure, true) / at25, 2, 0.1);
    EXPECT_NEAR(darkDn(18, kExposure, true) / at25, 0.5, 0.05);
}

std::vector<double> hotOf(const Sensor& sensor) {
    std::vector<double> hot;
    const auto pixels = static_cast<std::uint64_t>(kSensorSize.pixels());
    for (std::uint64_t i = 0; i < pixels; ++i) {
        const double dark = sensor.darkCurrent(i);
        if (dark != kDarkAt25) hot.push_back(dark);
    }
    return hot;
}

TEST(Sensor, OnePixelInFiveThousandIsHotAsManyInEachOctave) {
    std::vector<double> hot = hotOf(Sensor("SIM-0001"));
    const double expected = kHotShare * static_cast<double>(kSensorSize.pixels());  // 262
    EXPECT_NEAR(static_cast<double>(hot.size()), expected, 4 * std::sqrt(expected));
    std::sort(hot.begin(), hot.end());
    EXPECT_GE(hot.front(), kLeastHotAt25);
    EXPECT_LE(hot.back(), kHottestAt25);
    // ln(dark current) is uniform: no quantile is off by more than 4 x 0.5 / sqrt(262).
    for (std::size_t i = 0; i < hot.size(); ++i) {
        const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(hot.size());
        EXPECT_NEAR(std::log(hot[i] / 30) / std::log(100), share, 0.125);
    }
}

TEST(Sensor, HotPixelsAreThoseOfTheSerialNumber) {
    EXPECT_EQ(hotOf(Sensor("SIM-0001")), hotOf(Sensor("SIM-0001", 60)));
    EXPECT_NE(hotOf(Sensor("SIM-0001")), hotOf(Sensor("SIM-0002")));
}

TEST(Sensor, AHotPixelIsHotInEveryView) {
    const Sensor sensor("SIM-0001");
    constexpr Nanoseconds kExposure(1'000'000'000);
    constexpr View kPart{.x = 400, .y = 300, .size = {256, 256}};
    const auto frame = sensor.expose(nullptr, 0, kExposure, kPart, {1, 1, 0}, 1);
    int hot = 0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            const int pixel = (kPart.y + y) * kSensorSize.width + kPart.x + x;
            const double electrons = sensor.darkCurrent(static_cast<std::uint64_t>(pixel));
            if (electrons < 100) continue;
            ++hot;
            EXPECT_NEAR(frame.at(x, y), 60 + electrons / 2.6, 6 * std::sqrt(electrons) / 2.6);
        }
    }
    EXPECT_GT(hot, 3);
}

TEST(Sensor, PixelsKeepTheirResponseInEveryView) {
    const Sensor sensor("SIM-0001");
    constexpr Size kWhole = kSensorSize;
    constexpr View kPart{.x = 640, .y = 512, .size = {64, 32}};
    const Image<float> bright(kWhole, 5e6F);
    const Image<float> brightPart(kPart.size, 5e6F);
    constexpr Nanoseconds kExposure(1'000'000);
    const auto whole = sensor.expose(&bright, 1, kExposure, {}, {1, 1, 0}, 1);
    const auto part = sensor.expose(&brightPart, 1, kExposure, kPart, {1, 1, 0}, 1);
    for (int y = 0; y < kPart.size.height; ++y) {
        for (int x = 0; x < kPart.size.width; ++x) {
            ASSERT_EQ(part.at(x, y), whole.at(kPart.x + x, kPart.y + y)) << x << ' ' << y;
        }
    }
}

}  // namespace
}  // namespace gonio::sim
