#include "proc/estimate/half_float.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace gonio::proc {
namespace {

/// By the definition of the format.
double valueOf(std::uint16_t bits) {
    const int exponent = bits >> 10 & 0x1f;
    const int fraction = bits & 0x3ff;
    const double size =
        exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
    return (bits & 0x8000) != 0 ? -size : size;
}

bool isNumber(std::uint16_t bits) { return (bits >> 10 & 0x1f) != 0x1f; }

TEST(Half16, EveryOneReadsAsItsDefinitionAndComesBack) {
    for (std::uint32_t k = 0; k <= 0xffff; ++k) {
        const auto bits = static_cast<std::uint16_t>(k);
        if (!isNumber(bits)) continue;
        ASSERT_EQ(static_cast<double>(toFloat({bits})), valueOf(bits)) << bits;
        ASSERT_EQ(toHalf(toFloat({bits})).bits, bits);
    }
}

TEST(Half16, RoundsToTheNearestAndTiesToEven) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> exponent(-26, 15);
    for (int i = 0; i < 200000; ++i) {
        const float value = std::exp2(exponent(random));
        const auto near = static_cast<std::uint16_t>(toHalf(value).bits);
        for (const int step : {-1, 1}) {
            const auto other = static_cast<std::uint16_t>(near + step);
            if (near == 0 && step < 0) continue;
            if (!isNumber(other)) continue;
            const double own = std::abs(valueOf(near) - static_cast<double>(value));
            const double theirs = std::abs(valueOf(other) - static_cast<double>(value));
            ASSERT_LE(own, theirs) << value;
            if (own == theirs) {
                ASSERT_EQ(near % 2, 0) << value;
            }
        }
    }
}

TEST(Half16, KeepsSignsInfinitiesAndNan) {
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(toHalf(-0.0F).bits, 0x8000);
    EXPECT_EQ(toFloat(toHalf(-3.5F)), -3.5F);
    EXPECT_EQ(toFloat(toHalf(65519.9F)), 65504.0F);
    EXPECT_EQ(toFloat(toHalf(65520.0F)), infinity);
    EXPECT_EQ(toFloat(toHalf(-infinity)), -infinity);
    EXPECT_TRUE(std::isnan(toFloat(toHalf(std::nanf("")))));
}

}  // namespace
}  // namespace gonio::proc
