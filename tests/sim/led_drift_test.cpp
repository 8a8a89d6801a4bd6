#include "sim/led_drift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gonio::sim {
namespace {

using namespace std::chrono_literals;

constexpr double kSize = 0.002;

Settings lit(int led, Band band, double level = 1) {
    Settings settings{.led = led};
    settings.levels[index(band)] = static_cast<std::uint16_t>(std::lround(65535 * level));
    return settings;
}

TEST(LedDrift, SizeZeroIsOneExactly) {
    LedDrift drift(7, 0);
    drift.run(lit(1, Band::R), 10s);
    for (std::uint64_t step = 0; step < 500; step += 7) {
        for (Band b : kBands) EXPECT_EQ(drift.output(1, step)[b], 1);
    }
}

TEST(LedDrift, TheBoardWarmsUpExponentiallyToTheDriveLevelAndCoolsInTheDark) {
    LedDrift drift(7, kSize);
    EXPECT_EQ(drift.heat(), 0);
    drift.run(lit(2, Band::G, 0.5), 2s);
    EXPECT_NEAR(drift.heat(), 0.5 * (1 - std::exp(-1.0)), 1e-5);
    drift.run(lit(2, Band::G, 0.5), 100s);
    EXPECT_NEAR(drift.heat(), 0.5, 1e-5);
    EXPECT_NEAR(drift.boardKelvin(), 1.5, 3e-5);
    drift.run({}, 2s);
    EXPECT_NEAR(drift.heat(), 0.5 * std::exp(-1.0), 1e-5);
    drift.run(lit(1, Band::R), 100s);  // another is lit
    EXPECT_NEAR(drift.heat(), 1, 1e-5);
}

TEST(LedDrift, ManyShortExposuresHeatAsOneLongOne) {
    LedDrift once(7, kSize), often(7, kSize);
    once.run(lit(0, Band::R), 500ms);
    for (int i = 0; i < 50; ++i) often.run(lit(0, Band::R), 10ms);
    EXPECT_NEAR(once.heat(), often.heat(), 1e-12);
}

TEST(LedDrift, HeatCostsRedMost) {
    const LedDrift cold(7, kSize);
    const auto loss = [&](Band band) {
        LedDrift drift(7, kSize);
        drift.run(lit(3, band), 1000s);
        return cold.output(3, 5)[band] - drift.output(3, 5)[band];
    };
    EXPECT_NEAR(loss(Band::R), 2 * kSize, 1e-12);
    EXPECT_NEAR(loss(Band::G), 0.5 * kSize, 1e-12);
    EXPECT_NEAR(loss(Band::B), 0.5 * kSize, 1e-12);
}

TEST(LedDrift, TheWanderIsAStandardNormalAtEachPlanStep) {
    // At a node, between two, and halfway, over 600 seeds x 12 streams: the mean square is known
    // to sqrt(2 / 7200) = 1.7 %.
    for (const std::uint64_t step : {64U, 80U, 96U, 127U}) {
        double sum = 0, squares = 0, count = 0;
        for (std::uint64_t seed = 0; seed < 600; ++seed) {
            const LedDrift drift(seed, kSize);
            for (int led = 0; led < kLeds; ++led) {
                for (Band b : kBands) {
                    const double z = drift.wander(led, b, step);
                    sum += z;
                    squares += z * z;
                    ++count;
                }
            }
        }
        EXPECT_NEAR(squares / count, 1, 0.07) << step;
        EXPECT_NEAR(sum / count, 0, 0.05) << step;
    }
}

TEST(LedDrift, TheWanderIsSlowAndForgets) {
    double near = 0, far = 0, count = 0;
    for (std::uint64_t seed = 0; seed < 600; ++seed) {
        const LedDrift drift(seed, kSize);
        for (int led = 0; led < kLeds; ++led) {
            for (Band b : kBands) {
                const double z = drift.wander(led, b, 90);
                near += std::pow(drift.wander(led, b, 96) - z, 2);  // a bracket later
                far += drift.wander(led, b, 90 + 128) * z;
                ++count;
            }
        }
    }
    EXPECT_LT(std::sqrt(near / count), 0.2);
    EXPECT_NEAR(far / count, 0, 4 / std::sqrt(count));
}

TEST(LedDrift, TheSeedDrawsItAndEachLedAndBandHasItsOwn) {
    const LedDrift one(1, kSize), again(1, kSize), other(2, kSize);
    EXPECT_EQ(one.wander(0, Band::R, 100), again.wander(0, Band::R, 100));
    EXPECT_NE(one.wander(0, Band::R, 100), other.wander(0, Band::R, 100));
    EXPECT_NE(one.wander(0, Band::R, 100), one.wander(1, Band::R, 100));
    EXPECT_NE(one.wander(0, Band::R, 100), one.wander(0, Band::G, 100));
}

TEST(LedDrift, AStepMultipliesTheOutputFromItsPlanStepOn) {
    const LedDrift steady(7, kSize);
    const LedDrift stepped(7, kSize, {.size = -0.05, .planStep = 300});
    for (int led = 0; led < kLeds; ++led) {
        for (Band b : kBands) {
            EXPECT_EQ(stepped.output(led, 299)[b], steady.output(led, 299)[b]);
            EXPECT_NEAR(stepped.output(led, 300)[b] / steady.output(led, 300)[b], 0.95, 1e-15);
            EXPECT_NEAR(stepped.output(led, 900)[b] / steady.output(led, 900)[b], 0.95, 1e-15);
        }
    }
    EXPECT_EQ(LedDrift(7, 0, {.size = 0.05, .planStep = 3}).output(0, 3), LedBands::all(1.05));
}

}  // namespace
}  // namespace gonio::sim
