#include "proc/radiance/noise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gonio::proc {
namespace {

const SensorNoise kNoise{
    .electronsPerDn = 2, .readNoiseElectrons = 3, .darkElectronsPerSecond = 5, .fullScaleDn = 4000};

TEST(SensorNoise, DarkVarianceIsReadNoiseRoundingAndDarkCurrent) {
    EXPECT_DOUBLE_EQ(kNoise.darkVariance(0), 3 * 3 + 2 * 2 / 12.0);
    EXPECT_DOUBLE_EQ(kNoise.darkVariance(10) - kNoise.darkVariance(0), 50);
}

TEST(SensorNoise, LightAddsItsElectrons) {
    for (double electrons : {0.0, 1.0, 1e4})
        EXPECT_DOUBLE_EQ(kNoise.variance(electrons, 2), electrons + kNoise.darkVariance(2));
}

TEST(SensorNoise, IsNeverBelowThatOfADarkPixel) {
    for (double electrons : {-1e-9, -3.0, -1e9})
        EXPECT_EQ(kNoise.variance(electrons, 1), kNoise.darkVariance(1));
}

TEST(SensorNoise, SaturationBeginsAtNinetyFivePerCentOfFullScale) {
    EXPECT_DOUBLE_EQ(kNoise.saturationDn(), 3800);
    EXPECT_DOUBLE_EQ(SensorNoise{}.saturationDn(), 3890.25);
}

/// By the normal distribution itself: the rms of E[round(x + noise)] - x over all x.
double roundingErrorByIntegration(double sigma) {
    constexpr int kLights = 500, kFarthest = 12;
    const auto below = [&](double to) { return 0.5 * std::erfc(-to / sigma / std::sqrt(2.0)); };
    double squares = 0;
    for (int i = 0; i < kLights; ++i) {
        const double x = (i + 0.5) / kLights;
        double mean = 0;
        for (int dn = -kFarthest; dn <= kFarthest; ++dn)
            mean += dn * (below(dn + 0.5 - x) - below(dn - 0.5 - x));
        squares += (mean - x) * (mean - x) / kLights;
    }
    return std::sqrt(squares);
}

TEST(RoundingError, IsThatOfTheNormalDistribution) {
    EXPECT_NEAR(roundingErrorDn(0), std::sqrt(1 / 12.0), 1e-3);
    for (const double sigma : {0.02, 0.1, 0.23, 0.4, 0.7})
        EXPECT_NEAR(roundingErrorDn(sigma) / roundingErrorByIntegration(sigma), 1, 1e-4) << sigma;
    EXPECT_NEAR(roundingErrorDn(0.92), 1.25e-8, 1e-10);  // the first harmonic alone
}

}  // namespace
}  // namespace gonio::proc
