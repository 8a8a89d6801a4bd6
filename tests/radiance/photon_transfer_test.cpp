#include "proc/radiance/photon_transfer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/radiance/frames.h"

namespace gonio::proc {
namespace {

using test::Shot;
using test::take;

constexpr Size kSize{64, 64};
constexpr double kLight = 1e6;  // electrons per second

/// Pairs of the given exposures; 0 seconds: a dark pair of 1 us.
std::vector<Frame> framesOf(const std::vector<double>& seconds,
                            std::mt19937_64& random,
                            const SensorNoise& noise = {}) {
    std::vector<Frame> frames;
    for (const double s : seconds) {
        const Shot shot{.electronsPerSecond = kLight,
                        .seconds = s > 0 ? s : 1e-6,
                        .level = static_cast<std::uint16_t>(s > 0 ? 65535 : 0)};
        for (int i = 0; i < 2; ++i) frames.push_back(take(shot, kSize, random, {}, noise));
    }
    return frames;
}

std::vector<FlatPair> pairsOf(const std::vector<Frame>& frames) {
    std::vector<FlatPair> pairs;
    for (std::size_t i = 0; i + 1 < frames.size(); i += 2)
        pairs.push_back({&frames[i], &frames[i + 1]});
    return pairs;
}

const std::vector<double> kSweep{0, 2e-5, 1e-4, 1e-3, 3e-3, 6e-3, 9e-3};

TEST(PhotonTransfer, FindsGainAndReadNoiseWithinTheirUncertainties) {
    std::mt19937_64 random(51);
    const SensorNoise sensor{.electronsPerDn = 2.2, .readNoiseElectrons = 3.1};
    double gain = 0, read = 0, chiSquare = 0, freedom = 0;
    constexpr int kRepeats = 30;
    for (int i = 0; i < kRepeats; ++i) {
        const std::vector<Frame> frames = framesOf({0, 2e-5, 1e-3, 4e-3, 8e-3}, random, sensor);
        const auto found = photonTransfer(pairsOf(frames), {});
        ASSERT_TRUE(found) << found.error().message;
        EXPECT_EQ(found->pairs, 5);
        const double gainPull = (found->electronsPerDn - 2.2) / found->uElectronsPerDn;
        const double readPull = (found->readNoiseElectrons - 3.1) / found->uReadNoiseElectrons;
        gain += gainPull * gainPull / kRepeats;
        read += readPull * readPull / kRepeats;
        chiSquare += found->chiSquare;
        freedom += static_cast<double>(found->freedom);
        EXPECT_LT(found->uElectronsPerDn, 0.05 * 2.2);
        EXPECT_LT(found->uReadNoiseElectrons, 0.05 * 3.1);
    }
    // Mean squares of 30 pulls: 1 +- 0.26; of 90 degrees of freedom: 1 +- 0.15.
    EXPECT_NEAR(gain, 1, 4 * 0.26);
    EXPECT_NEAR(read, 1, 4 * 0.26);
    EXPECT_NEAR(chiSquare / freedom, 1, 4 * 0.15);
}

TEST(PhotonTransfer, SaturatedPairsDoNotPull) {
    std::mt19937_64 random(52);
    std::vector<double> sweep = kSweep;
    // 9958 electrons are 95 %: at the border of the mask, beyond it, and far beyond it.
    for (const double s : {9.95e-3, 10.1e-3, 10.6e-3, 50e-3}) sweep.push_back(s);
    const std::vector<Frame> frames = framesOf(sweep, random);
    const auto found = photonTransfer(pairsOf(frames), {});
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_LT(found->pairs, 11);
    EXPECT_GE(found->pairs, 7);
    EXPECT_NEAR(found->electronsPerDn, 2.6, 4 * found->uElectronsPerDn);
    EXPECT_NEAR(found->readNoiseElectrons, 2.4, 4 * found->uReadNoiseElectrons);
}

TEST(PhotonTransfer, ADarkPairsMeanIsTheBlackLevel) {
    // The frames say 50 DN, the sensor has 60: without a dark pair the read noise is wrong by that.
    std::mt19937_64 random(53);
    std::vector<Frame> frames = framesOf(kSweep, random);
    for (Frame& frame : frames) frame.blackLevel = 50;
    const auto with = photonTransfer(pairsOf(frames), {});
    ASSERT_TRUE(with);
    EXPECT_NEAR(with->readNoiseElectrons, 2.4, 4 * with->uReadNoiseElectrons);
    frames.erase(frames.begin(), frames.begin() + 2);
    const auto without = photonTransfer(pairsOf(frames), {});
    ASSERT_TRUE(without);
    EXPECT_LT(without->readNoiseElectrons, 1);  // 10 DN are 3.8 DN^2 of shot noise
}

TEST(PhotonTransfer, ASceneThatIsNotFlatAndUnsteadyLightDoNotMatter) {
    std::mt19937_64 random(54);
    std::vector<Frame> frames;
    Image<double> light(kSize);
    for (int y = 0; y < kSize.height; ++y)
        for (int x = 0; x < kSize.width; ++x) light.at(x, y) = kLight * (0.4 + 0.6 * x / 64.0);
    for (const double s : {2e-5, 1e-3, 4e-3, 8e-3}) {
        for (int i = 0; i < 2; ++i) {
            Frame frame = test::takeScene(light, {.seconds = s * (i == 0 ? 1 : 1.002)}, random);
            frame.exposure.granted = Nanoseconds(std::llround(s * 1e9));
            frames.push_back(std::move(frame));
        }
    }
    const auto found = photonTransfer(pairsOf(frames), {});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->electronsPerDn, 2.6, 4 * found->uElectronsPerDn);
    EXPECT_NEAR(found->readNoiseElectrons, 2.4, 4 * found->uReadNoiseElectrons);
}

TEST(PhotonTransfer, WithoutReadNoiseItIsZeroNotNaN) {
    std::mt19937_64 random(55);
    const SensorNoise silent{.electronsPerDn = 2.6, .readNoiseElectrons = 0};
    const std::vector<Frame> frames = framesOf({2e-4, 1e-3, 4e-3}, random, silent);
    const auto found = photonTransfer(pairsOf(frames), silent);
    ASSERT_TRUE(found);
    EXPECT_TRUE(std::isfinite(found->readNoiseElectrons));
    EXPECT_LT(found->readNoiseElectrons, 5 * found->uReadNoiseElectrons);
}

TEST(PhotonTransfer, RefusesWhatSaysNothing) {
    std::mt19937_64 random(56);
    const auto message = [](const std::vector<Frame>& frames) {
        const auto found = photonTransfer(pairsOf(frames), {});
        if (found) return std::string("found");
        EXPECT_EQ(found.error().kind, ErrorKind::Quality);
        return found.error().message;
    };
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    EXPECT_TRUE(has(message({}), "0 usable pairs of 0"));
    EXPECT_TRUE(has(message(framesOf({0, 0, 0}, random)), "different light"));
    EXPECT_TRUE(has(message(framesOf({0, 0, 4e-3}, random)), "different light"));
    EXPECT_TRUE(has(message(framesOf({0, 4e-3, 4e-3}, random)), "different light"));
    EXPECT_TRUE(has(message(framesOf({1e-3, 2e-3}, random)), "2 usable pairs of 2"));
    EXPECT_TRUE(has(message(framesOf({0.1, 0.2, 0.3, 0}, random)), "1 usable pairs of 4"));
    std::vector<Frame> unlike = framesOf(kSweep, random);
    unlike[2].exposure.granted *= 2;
    EXPECT_TRUE(has(message(unlike), "not taken alike"));
    std::vector<Frame> still = framesOf({1e-3, 2e-3, 3e-3}, random);
    for (std::size_t i = 0; i + 1 < still.size(); i += 2) still[i + 1].pixels = still[i].pixels;
    EXPECT_TRUE(has(message(still), "does not rise"));
    const std::vector<FlatPair> none(1);
    EXPECT_FALSE(photonTransfer(none, {}));
}

}  // namespace
}  // namespace gonio::proc
