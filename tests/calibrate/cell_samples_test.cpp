#include "proc/calibrate/cell_samples.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gonio::proc {
namespace {

TEST(CellSamples, MissingIsNeverZero) {
    const CellSamples samples = CellSamples::missing(3);
    ASSERT_EQ(samples.size(), 3U);
    for (std::size_t cell = 0; cell < 3; ++cell) {
        EXPECT_FALSE(samples.present(cell));
        EXPECT_TRUE(std::isnan(samples.f[cell]));
        EXPECT_TRUE(std::isnan(samples.uRandom[cell]) && std::isnan(samples.uSystematic[cell]));
        EXPECT_EQ(samples.nEff[cell], 0);
        EXPECT_FALSE(samples.at(cell).present());
    }
    EXPECT_EQ(CellSamples::missing(0).size(), 0U);
}

TEST(CellSamples, ACellIsAMeasuredValue) {
    CellSamples samples = CellSamples::missing(2);
    samples.f[1] = 0.1;
    samples.uRandom[1] = 0.003;
    samples.uSystematic[1] = 0.004;
    samples.flags[1] = {Flag::Measured, Flag::BelowNoise};
    const Measured<double> value = samples.at(1);
    EXPECT_EQ(value.value, 0.1);
    EXPECT_DOUBLE_EQ(value.u(), 0.005);
    EXPECT_TRUE(value.flags.has(Flag::BelowNoise));
    EXPECT_TRUE(samples.present(1));
    EXPECT_FALSE(samples.present(0));
}

}  // namespace
}  // namespace gonio::proc
