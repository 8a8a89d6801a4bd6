#pragma once
// The cosine lobe cos^n and what has been proposed in its place: with c = cos, t = 1 - c given
// without cancellation, u = n t. Errors are against cos^n over [0, pi/2], n in 8..1000, absolute,
// in double; docs/powers.md has them all, with times.
//   pow        the library's
//   full75 full54  2^(n log2 c), polynomials of degree 7/5 and 5/4: 9.8e-8 (float 1.7e-7), 3.5e-6;
//              c in [0, 1], n in 0..1e6
//   lite       2^(-n P(t)), P ~ -log2(1 - t) of degree 5: 1.0e-5; n >= 8
//   sq8d3 sq8  q(u, t)^8, no division: 9.9e-5, 1.7e-3; n >= 8; sq8 leaves 1.5e-3 far from the peak
//   rec3m4 rec2m4  1 / d(u, t)^4, smooth: 2.0e-3, 1.0e-2; n >= 8
//   schlick    c / (n - n c + c) [Schlick1994]: 0.20
//   bps        a cubic of schlick [Zavalniuk2024]: 2.9e-2; as published: 0.9927 at the peak, down
//              to -0.0094 on the flank, 2.7e-3 far out
//   f8         (1 + (c - 1) n / 8)^8, cut at 0 [Romanyuk2008]: 3.5e-2
//   quadratic  0.786 n c^2 + (1 - 0.786 n) c, cut at 0 [Romanyuk2023]: 0.28
//   cubic      A c^3 + B c^2 + C c through 1/2 and 1/18, cut where it is least, which is not 0
//              [Romanyuk2023]: 0.11
//   gauss      exp(-n theta^2 / 2): 2.4e-2
//   lagarde    exp(-(n + 0.775)(1 - c)) [Lagarde2012]: 1.9e-2
// Ours approximate -ln(1 - t) / t instead of the curve: c^n = exp(-n L(t)), and a relative error e
// of L costs at most 0.37 e of the peak at any n. config/tools/fit_powers.py fits them anew.
// Below n = 8 take full75, full54 or pow: the others err by up to 0.22 there.

#include <array>
#include <concepts>
#include <string_view>

#include "proc/models/fast_exp.h"
#include "proc/models/kernel.h"

namespace gonio::proc {

enum class PowerForm {
    Pow,
    Full75,
    Full54,
    Lite,
    Sq8d3,
    Sq8,
    Rec3m4,
    Rec2m4,
    Schlick,
    Bps,
    F8,
    Quadratic,
    Cubic,
    Gauss,
    Lagarde
};

/// All of them, ours first.
inline constexpr std::array kPowerForms{PowerForm::Full75,
                                        PowerForm::Full54,
                                        PowerForm::Lite,
                                        PowerForm::Sq8d3,
                                        PowerForm::Sq8,
                                        PowerForm::Rec3m4,
                                        PowerForm::Rec2m4,
                                        PowerForm::Schlick,
                                        PowerForm::Bps,
                                        PowerForm::F8,
                                        PowerForm::Quadratic,
                                        PowerForm::Cubic,
                                        PowerForm::Gauss,
                                        PowerForm::Lagarde,
                                        PowerForm::Pow};
/// As a spec names it.
[[nodiscard]] constexpr std::string_view name(PowerForm form) {
    switch (form) {
        case PowerForm::Pow: return "pow";
        case PowerForm::Full75: return "full75";
        case PowerForm::Full54: return "full54";
        case PowerForm::Lite: return "lite";
        case PowerForm::Sq8d3: return "sq8d3";
        case PowerForm::Sq8: return "sq8";
        case PowerForm::Rec3m4: return "rec3m4";
        case PowerForm::Rec2m4: return "rec2m4";
        case PowerForm::Schlick: return "schlick";
        case PowerForm::Bps: return "bps";
        case PowerForm::F8: return "f8";
        case PowerForm::Quadratic: return "quadratic";
        case PowerForm::Cubic: return "cubic";
        case PowerForm::Gauss: return "gauss";
        case PowerForm::Lagarde: return "lagarde";
    }
    return "";
}

/// Proposed here, not in a paper nor by the library.
[[nodiscard]] constexpr bool isOurs(PowerForm form) {
    for (const PowerForm one : kPowerForms) {
        if (one == PowerForm::Schlick) return false;
        if (one == form) return true;
    }
    return false;
}

/// A cosine and 1 - cosine, the latter computed without cancellation.
template <class D>
struct NearOne {
    D c;
    D t;
};

/// log2 of the cosine: from t itself near 1, where c has lost it.
template <int Degree, std::floating_point T>
[[nodiscard]] inline T fastLog2(const NearOne<T>& x) {
    const Octave<T> m = octaveOf(x.c);
    const T s = m.octave == T(0) ? -x.t : m.s;
    return m.octave + fastLog2Near1<Degree>(s);
}

template <std::floating_point T>
[[nodiscard]] inline T eighthPower(T q) {
    const T q2 = q * q;
    const T q4 = q2 * q2;
    return q4 * q4;
}

template <std::floating_point T>
[[nodiscard]] inline T sq8(T n, const NearOne<T>& x) {
    const T u = std::min(n * x.t, T(9.03378256));
    return eighthPower(T(1) + u * (T(-0.125) + T(0.0070169056) * u - T(0.05384407) * x.t));
}

template <std::floating_point T>
[[nodiscard]] inline T sq8d3(T n, const NearOne<T>& x) {
    const T u = std::min(n * x.t, T(26.5));
    const T t = x.t;
    const T cubic = T(0.00027106) * u * u - t * (T(0.006648) * u - T(0.03584086) * t);
    const T q = T(1) + u * (T(-0.125) + T(0.00773836734) * u - T(0.06172579875) * t - cubic);
    return eighthPower(std::max(T(0), q));
}

template <std::floating_point T>
[[nodiscard]] inline T rec2m4(T n, const NearOne<T>& x) {
    const T u = n * x.t;
    const T d = T(1) + u * (T(0.25) + T(0.0409677233) * u + T(0.196046266) * x.t);
    const T inverse = T(1) / (d * d);  // d^4 may be too large for a float
    return inverse * inverse;
}

template <std::floating_point T>
[[nodiscard]] inline T rec3m4(T n, const NearOne<T>& x) {
    const T u = n * x.t;
    const T t = x.t;
    const T slope = T(0.0296778113) + T(0.0992232908) * t + T(0.00299664152) * u;
    const T d = T(1) + u * (T(0.25) + T(0.0808453961) * t + u * slope);
    const T inverse = T(1) / (d * d);  // d^4 may be too large for a float
    return inverse * inverse;
}

template <std::floating_point T>
[[nodiscard]] inline T lite5(T n, const NearOne<T>& x) {
    const T t = x.t;
    const T log = t * (T(1.442731028) +
                       t * (T(0.7174031103) +
                            t * (T(0.5482120418) + t * (T(-0.0153642856) + t * T(1.0221755985)))));
    return fastExp2<4>(-n * log);
}

template <std::floating_point T>
[[nodiscard]] inline T schlickPower(T n, const NearOne<T>& x) {
    return x.c / (n * x.t + x.c);
}

template <std::floating_point T>
[[nodiscard]] inline T bps(T n, const NearOne<T>& x) {
    const T s = schlickPower(n, x);
    return s * (T(-0.374) + s * (T(2.995) - T(1.631) * s)) + T(2.737e-3);
}

template <std::floating_point T>
[[nodiscard]] inline T f8(T n, const NearOne<T>& x) {
    return eighthPower(std::max(T(0), T(1) - n * T(0.125) * x.t));
}

template <std::floating_point T>
[[nodiscard]] inline T quadraticPower(T n, const NearOne<T>& x) {
    return std::max(T(0), x.c * (T(1) - T(0.786) * n * x.t));
}

/// A c^3 + B c^2 + C c, which is 1/2 where cos^n is and 1/18 where cos^n is; of n alone. The same
/// cubic in t is c (1 - t (slope - A t)): A grows like n^2 and the terms in c cancel, those in t do
/// not.
struct CubicCoefficients {
    double a;
    double b;
    double c;
    double
        cut;  ///< the cosine of its first zero or, where it has none, of its least value; 0 below
    double slope;
    double tCut;  ///< 1 - cut; infinite where there is neither
};
[[nodiscard]] CubicCoefficients cubicCoefficients(double n);

/// Of CubicCoefficients, what an evaluation needs.
template <std::floating_point T>
struct CubicInT {
    T a;
    T slope;
    T tCut;
};

template <std::floating_point T>
[[nodiscard]] inline T cubicPower(const CubicInT<T>& k, const NearOne<T>& x) {
    return x.t < k.tCut ? x.c * (T(1) - x.t * (k.slope - k.a * x.t)) : T(0);
}

template <PowerForm Form, std::floating_point T>
[[nodiscard]] inline T power(T n, const NearOne<T>& x) {
    if constexpr (Form == PowerForm::Full75) return fastExp2<5>(n * fastLog2<7>(x));
    if constexpr (Form == PowerForm::Full54) return fastExp2<4>(n * fastLog2<5>(x));
    if constexpr (Form == PowerForm::Lite) return lite5(n, x);
    if constexpr (Form == PowerForm::Sq8d3) return sq8d3(n, x);
    if constexpr (Form == PowerForm::Sq8) return sq8(n, x);
    if constexpr (Form == PowerForm::Rec3m4) return rec3m4(n, x);
    if constexpr (Form == PowerForm::Rec2m4) return rec2m4(n, x);
    if constexpr (Form == PowerForm::Schlick) return schlickPower(n, x);
    if constexpr (Form == PowerForm::Bps) return bps(n, x);
    if constexpr (Form == PowerForm::F8) return f8(n, x);
    if constexpr (Form == PowerForm::Quadratic) return quadraticPower(n, x);
    if constexpr (Form == PowerForm::Cubic) {
        const CubicCoefficients k = cubicCoefficients(static_cast<double>(n));
        return cubicPower({static_cast<T>(k.a), static_cast<T>(k.slope), static_cast<T>(k.tCut)},
                          x);
    }
    if constexpr (Form == PowerForm::Gauss) {
        // theta = 2 asin(sqrt(t / 2)): exact where acos(c) has lost it.
        const T half = std::asin(std::sqrt(x.t * T(0.5)));
        return std::exp(T(-2) * n * half * half);
    }
    if constexpr (Form == PowerForm::Lagarde) return std::exp(-(n + T(0.775)) * x.t);
    if constexpr (Form == PowerForm::Pow) {
        // Near 1 by log1p of the exact t: pow(c, n) would carry n times the rounding of c.
        return x.c > T(0.5) ? std::exp(n * std::log1p(-x.t)) : std::pow(x.c, n);
    }
}

}  // namespace gonio::proc
