#include "proc/radiance/noise.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace gonio::proc
