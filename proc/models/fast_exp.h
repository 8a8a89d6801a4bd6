#pragma once
// 2^x and log2(x) from a polynomial and the exponent's bits, for float and double: what a loop over
// an array can do several at a time, where the library's functions cannot. Polynomials fitted by
// linear programming (config/tools/fit_powers.py), exp2 to the least relative error, log2 to the
// least that it does to any power c^n of a c in (0, 1]:
//   exp2<3> 1.0e-4, exp2<4> 2.8e-6, exp2<5> 9.1e-8;  log2<5> 2.2e-6, log2<7> 4.9e-8.
// exp2: x below -126 is taken as -126 (1e-38) and above 126 as 126; NaN stays NaN in no promise.

#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "proc/core/effort.h"
#include "proc/models/kernel.h"

namespace gonio::proc {

/// Where a number's exponent stands, and sqrt(1/2) as bits: log2 is cut at [sqrt(1/2), sqrt(2)).
template <class T>
struct FloatBits;
template <>
struct FloatBits<float> {
    using Signed = std::int32_t;
    static constexpr int kMantissa = 23;
    static constexpr Signed kRootHalf = 0x3f3504f3;
};
template <>
struct FloatBits<double> {
    using Signed = std::int64_t;
    static constexpr int kMantissa = 52;
    static constexpr Signed kRootHalf = 0x3fe6a09e667f3bcd;
};

template <int Degree, std::floating_point T>
[[nodiscard]] inline T fastExp2(T x) {
    static_assert(Degree >= 3 && Degree <= 5);
    using Bits = FloatBits<T>;
    const T bounded = std::min(std::max(x, T(-126)), T(126));
    // Adding and subtracting 1.5 * 2^mantissa rounds to the nearest whole number and leaves it in
    // the low bits as well.
    constexpr T kRound = T(3) * T(std::int64_t(1) << (Bits::kMantissa - 1));
    const T shifted = bounded + kRound;
    const T whole = shifted - kRound;
    const T f = bounded - whole;
    T p;
    if constexpr (Degree == 3) {
        p = T(0.6932829573) + f * (T(0.2422109707) + f * T(0.055008823));
    } else if constexpr (Degree == 4) {
        p = T(0.6931241934) + f * (T(0.2402409859) + f * (T(0.0559064247) + f * T(0.0095828538)));
    } else {
        p = T(0.6931469775) +
            f * (T(0.2402224207) +
                 f * (T(0.0555073383) + f * (T(0.0096715135) + f * T(0.0013264711))));
    }
    const auto exponent = std::bit_cast<typename Bits::Signed>(shifted) << Bits::kMantissa;
    const auto value = std::bit_cast<typename Bits::Signed>(T(1) + f * p);
    return std::bit_cast<T>(value + exponent);
}

/// A number near 1 and its octave: x = (1 + s) 2^octave, 1 + s in [sqrt(1/2), sqrt(2)).
template <std::floating_point T>
struct Octave {
    T s;
    T octave;
};

/// x a normal number above 0; what is below is taken as the least octave.
template <std::floating_point T>
[[nodiscard]] inline Octave<T> octaveOf(T x) {
    using Bits = FloatBits<T>;
    using Unsigned = std::make_unsigned_t<typename Bits::Signed>;
    constexpr auto kOne = std::bit_cast<Unsigned>(T(1));
    constexpr auto kBias = kOne >> Bits::kMantissa;
    constexpr T kWhole = T(std::int64_t(1) << Bits::kMantissa);
    // Biased, so that the shift is one of unsigned numbers, and made a T by its bits: before
    // AVX-512 there is neither a signed shift nor a conversion of 64 bits in vectors.
    const auto bits = std::bit_cast<Unsigned>(x);
    const Unsigned octave =
        (bits + (kOne - static_cast<Unsigned>(Bits::kRootHalf))) >> Bits::kMantissa;
    const T m = std::bit_cast<T>(bits + kOne - (octave << Bits::kMantissa));
    const T number = std::bit_cast<T>(octave | std::bit_cast<Unsigned>(kWhole));
    return {m - T(1), number - (kWhole + T(kBias))};
}

/// log2(1 + s) for 1 + s in [sqrt(1/2), sqrt(2)].
template <int Degree, std::floating_point T>
[[nodiscard]] inline T fastLog2Near1(T s) {
    static_assert(Degree == 5 || Degree == 7);
    if constexpr (Degree == 5) {
        return s *
               (T(1.4427038929) +
                s * (T(-0.7212492251) +
                     s * (T(0.4795155014) +
                          s * (T(-0.3655466023) + s * (T(0.3211178221) + s * T(-0.2131786029))))));
    } else {
        return s * (T(1.4426948463) +
                    s * (T(-0.7213516044) +
                         s * (T(0.4809462226) +
                              s * (T(-0.3602755440) +
                                   s * (T(0.2865629859) +
                                        s * (T(-0.2481414430) +
                                             s * (T(0.2374071229) + s * T(-0.1515066975))))))));
    }
}

/// e^x at an effort: draft 2.8e-6, standard 9e-8 relative (and 1e-38 below x = -87), reference the
/// library's. Dual numbers take the library's at every effort.
template <Effort E, class T>
[[nodiscard]] inline T expOf(const T& x) {
    using std::exp;
    if constexpr (E == Effort::Reference || !std::floating_point<T>) {
        return exp(x);
    } else {
        const T y = x * T(1.4426950408889634);
        const T power = E == Effort::Draft ? fastExp2<4>(y) : fastExp2<5>(y);
        return y > T(-126) ? power : T(0);
    }
}

}  // namespace gonio::proc
