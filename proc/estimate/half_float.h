#pragma once
// Numbers of 16 bits (IEEE 754 binary16) for stored tables: 11 significant bits, 6e-5 to 65504,
// below that in steps of 6e-8. By integer operations alone, so that every machine holds the same
// bits; without a branch, so that a compiler makes vectors of them.

#include <bit>
#include <cmath>
#include <cstdint>

namespace gonio::proc {

struct Half16 {
    std::uint16_t bits = 0;

    bool operator==(const Half16&) const = default;
};

/// To nearest, ties to even; beyond 65504 it is infinity, NaN stays NaN.
[[nodiscard]] inline Half16 toHalf(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t sign = (bits >> 16) & 0x8000U;
    const std::uint32_t size = bits & 0x7fffffffU;
    const auto half = [sign](std::uint32_t rest) {
        return Half16{static_cast<std::uint16_t>(sign | rest)};
    };
    if (size > 0x7f800000U) return half(0x7e00U);
    if (size >= 0x477ff000U) return half(0x7c00U);  // 65520 and above
    if (size < 0x38800000U) {
        // Below 2^-14: in units of 2^-24, rounded by the addition of a number whose last bit that
        // is.
        const float shifted = std::bit_cast<float>(size) + 0.5F;
        return half(std::bit_cast<std::uint32_t>(shifted) - std::bit_cast<std::uint32_t>(0.5F));
    }
    const std::uint32_t odd = (size >> 13) & 1U;
    return half((size - 0x38000000U + 0xfffU + odd) >> 13);
}

/// Exact.
[[nodiscard]] inline float toFloat(Half16 half) {
    const std::uint32_t sign = static_cast<std::uint32_t>(half.bits & 0x8000U) << 16;
    const std::uint32_t rest = static_cast<std::uint32_t>(half.bits & 0x7fffU) << 13;
    // The exponent is off by 112: a product sets it right, denormals included.
    const float size = std::bit_cast<float>(rest) * 0x1p112F;
    const std::uint32_t special = rest >= 0x0f800000U ? 0x7f800000U : 0U;
    return std::bit_cast<float>(sign | std::bit_cast<std::uint32_t>(size) | special);
}

}  // namespace gonio::proc
