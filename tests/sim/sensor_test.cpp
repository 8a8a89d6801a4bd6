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
    const Sensor sensor("SIM-0001", {.celsius = celsius});
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

TEST(Sensor, DoublesAsItsErrorsSayUpToEightyDegrees) {
    // 3 e-/s at 25 degC; 55 K later, at 40 ms, 0.04 x 3 x 2^(55 / k) electrons: 69, 28 and 14.
    const auto darkAt80 = [](double doublingKelvin) {
        const Sensor sensor("SIM-0001", {.celsius = 80, .doublingKelvin = doublingKelvin});
        const auto frame =
            sensor.expose(nullptr, 0, Nanoseconds(40'000'000), {.size = kSmall}, {1, 1, 0}, 1);
        std::vector<std::uint16_t> dn(frame.pixels().begin(), frame.pixels().end());
        std::nth_element(dn.begin(), dn.begin() + 80'000, dn.end());
        return 2.6 * (dn[80'000] - kBlackLevel);  // the median: hot pixels left out
    };
    for (const double k : {6.0, 7.0, 8.0}) {
        EXPECT_NEAR(darkAt80(k), 0.12 * std::exp2(55 / k), 2.6) << k;  // one DN
    }
}

TEST(Sensor, AtEightyDegreesEveryPixelStillIsANumberWithinItsScale) {
    const Sensor sensor("SIM-0001", {.celsius = 80, .doublingKelvin = 6});
    const auto frame =
        sensor.expose(nullptr, 0, Nanoseconds(1'000'000'000), {.size = {64, 64}}, {1, 1, 0}, 1);
    for (std::uint16_t dn : frame.pixels()) EXPECT_LE(dn, kFullScale);
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
    EXPECT_EQ(hotOf(Sensor("SIM-0001")), hotOf(Sensor("SIM-0001", {.celsius = 60})));
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

TEST(Sensor, ColumnNoiseHasItsSigmaAndIsAnotherInEachFrame) {
    // The mean of a dark column of 1024 pixels has 2.4 / 32 e- of read noise and as good as no
    // rounding left: sigma of 1280 columns is known to 2 %.
    const Sensor quiet("SIM-0001");
    const Sensor noisy("SIM-0001", {.columnNoise = 1.5});
    const auto columns = [&](const Sensor& sensor, std::uint64_t frameIndex) {
        const auto frame =
            sensor.expose(nullptr, 0, Nanoseconds(20'000), {}, {1, 1, frameIndex}, 1);
        std::vector<double> means(static_cast<std::size_t>(frame.width()));
        for (int y = 0; y < frame.height(); ++y) {
            for (int x = 0; x < frame.width(); ++x) {
                means[static_cast<std::size_t>(x)] +=
                    2.6 * (frame.at(x, y) - kBlackLevel) / frame.height();
            }
        }
        return means;
    };
    const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
        return sum / static_cast<double>(a.size());
    };
    const auto first = columns(noisy, 0);
    EXPECT_NEAR(std::sqrt(product(first, first)), 1.5, 0.1);
    EXPECT_NEAR(product(first, columns(noisy, 1)), 0, 4 * 1.5 * 1.5 / std::sqrt(1280));
    EXPECT_LT(std::sqrt(product(columns(quiet, 0), columns(quiet, 0))), 0.1);
    EXPECT_EQ(columns(noisy, 0), first);
}

TEST(Sensor, AColumnIsOffByTheSameInEveryView) {
    const Sensor noisy("SIM-0001", {.columnNoise = 5});
    constexpr View kPart{.x = 640, .y = 512, .size = {64, 32}};
    const auto whole = noisy.expose(nullptr, 0, Nanoseconds(20'000), {}, {1, 1, 0}, 1);
    const auto part = noisy.expose(nullptr, 0, Nanoseconds(20'000), kPart, {1, 1, 0}, 1);
    for (int x = 0; x < 64; ++x) EXPECT_EQ(part.at(x, 9), whole.at(640 + x, 521));
}

/// Mean electrons read of a pixel that collects so many.
double readOf(const RigErrors& errors, double collected) {
    const Sensor sensor("SIM-0001", errors);
    const Image<float> rate(kSmall, static_cast<float>(collected * 1e3));
    const auto frame =
        sensor.expose(&rate, 1, Nanoseconds(1'000'000), {.size = kSmall}, {1, 1, 0}, 1);
    double sum = 0;
    for (std::uint16_t dn : frame.pixels()) sum += dn - kBlackLevel;
    return 2.6 * sum / static_cast<double>(frame.pixels().size());
}

TEST(Sensor, ItsResponseBowsByTheNonLinearityAtHalfOfFullWell) {
    // The same uniforms with and without: the difference has next to no noise. What non-uniformity
    // and shot noise do to a parabola: 4 inl / F (c + (0.007 c)^2), below 0.02 e-.
    const RigErrors bent{.nonLinearity = 0.003};
    const auto added = [&](double collected) {
        return readOf(bent, collected) - readOf({}, collected);
    };
    EXPECT_NEAR(added(0), 0, 0.02);
    EXPECT_NEAR(added(kFullWell / 2), 0.003 * kFullWell, 0.2);
    EXPECT_NEAR(added(kFullWell / 10), 0.003 * kFullWell * 4 * 0.1 * 0.9, 0.1);
    // Near zero it is steeper by 4 inl.
    EXPECT_NEAR(added(100), 0.012 * 100 * (1 - 100 / kFullWell), 0.05);
    EXPECT_NEAR(readOf({.nonLinearity = -0.003}, kFullWell / 2) - readOf({}, kFullWell / 2),
                -0.003 * kFullWell,
                0.2);
}

TEST(Sensor, NonUniformityHasItsSize) {
    const Sensor even("SIM-0001", {.nonUniformity = 0});
    const Sensor rough("SIM-0001", {.nonUniformity = 0.02});
    const Sensor usual("SIM-0001");
    for (std::uint64_t i = 0; i < 100; ++i) {
        EXPECT_EQ(even.response(i), 1);
        EXPECT_NEAR((rough.response(i) - 1) / (usual.response(i) - 1), 0.02 / 0.007, 1e-9);
    }
}

TEST(Sensor, FewerBitsMakeCoarserDigits) {
    const Digits twelve = digitsOf(12);
    EXPECT_EQ(twelve.blackLevel, kBlackLevel);
    EXPECT_EQ(twelve.fullScale, kFullScale);
    EXPECT_EQ(twelve.electronsPerDn, 2.6);
    EXPECT_EQ(digitsOf(10).blackLevel, 15);
    EXPECT_EQ(digitsOf(10).fullScale, 1023);
    EXPECT_EQ(digitsOf(8).blackLevel, 4);
    EXPECT_EQ(digitsOf(8).fullScale, 255);
    for (const int bits : {8, 10, 12}) {
        const Digits digits = digitsOf(bits);
        const Sensor sensor("SIM-0001", {.bits = bits});
        const auto mean = [&](float rate) {
            const Image<float> light(kSmall, rate);
            const auto frame =
                sensor.expose(&light, 1, Nanoseconds(1'000'000), {.size = kSmall}, {1, 1, 0}, 1);
            double sum = 0;
            for (std::uint16_t dn : frame.pixels()) sum += dn - digits.blackLevel;
            return digits.electronsPerDn * sum / static_cast<double>(frame.pixels().size());
        };
        // 5000 e- to 0.2 e- by noise; by PRNU to 0.1 e-.
        EXPECT_NEAR(mean(5e6F), 5000, 1) << bits;
        const Image<float> glaring({8, 8}, 1e9F);
        const auto full =
            sensor.expose(&glaring, 1, Nanoseconds(1'000'000), {.size = {8, 8}}, {1, 1, 0}, 2);
        for (std::uint16_t dn : full.pixels()) EXPECT_GE(dn, digits.fullScale - 2) << bits;
    }
}

}  // namespace
}  // namespace gonio::sim
