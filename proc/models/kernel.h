#pragma once
// What the kernels of the models are written in: directions, half vectors and bands of any number
// type. A kernel is a struct template over the number type P of its parameters, with
//   template <Effort E, class D> Bands<P> f(const Pair<D>& pair) const;
// f in 1/sr for directions of number type D, both above the horizon. float and double evaluate; a
// fit differentiates with P a dual number and D double, so that the geometry is worked out in plain
// double. One formula serves all three, and the same code runs one pair or an array of them.
//
// A kernel whose formula depends on E says so with `static constexpr bool kByEffort = true`.
//
// Grazing directions: a cosine below kGrazing (6e-9 degrees above the horizon) is evaluated at
// kGrazing, so that squares and quotients of cosines stay normal numbers in float too.

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/core/bands.h"
#include "proc/core/direction.h"
#include "proc/core/effort.h"

namespace gonio::proc {

inline constexpr double kGrazing = 1e-10;

template <class T>
struct Vec {
    T x{};
    T y{};
    T z{};

    constexpr Vec operator+(const Vec& o) const { return {x + o.x, y + o.y, z + o.z}; }
};

template <class T>
constexpr T dot(const Vec<T>& a, const Vec<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Where the light is and where the camera is, in the number type of an evaluation.
template <class D>
struct Pair {
    Vec<D> in;
    Vec<D> out;
};

template <class D>
[[nodiscard]] Pair<D> pairOf(const LightView& pair) {
    const auto narrow = [](const Direction& w) {
        return Vec<D>{static_cast<D>(w.x()),
                      static_cast<D>(w.y()),
                      static_cast<D>(std::max(w.z(), kGrazing))};
    };
    return {narrow(pair.in), narrow(pair.out)};
}

/// The half vector, not normalised: H = wi + wo keeps its digits where a unit h has lost them.
template <class D>
struct Half {
    Vec<D> h;
    D sin2;     ///< Hx^2 + Hy^2 = |H|^2 sin^2(theta_h)
    D cos2;     ///< Hz^2
    D length2;  ///< |H|^2
    D cosDiff;  ///< wi.h = wo.h = |H| / 2, at most 1

    explicit Half(const Pair<D>& pair)
        : h(pair.in + pair.out),
          sin2(h.x * h.x + h.y * h.y),
          cos2(h.z * h.z),
          length2(sin2 + cos2),
          cosDiff(std::min(D(1), std::sqrt(length2) / 2)) {}

    [[nodiscard]] D tan2() const { return sin2 / cos2; }
    [[nodiscard]] D cosTheta() const { return std::min(D(1), h.z / std::sqrt(length2)); }
    /// 1 - cos(theta_h), without a difference.
    [[nodiscard]] D oneMinusCosTheta() const {
        const D length = std::sqrt(length2);
        return sin2 / (length * (length + h.z));
    }
};

/// One number per LED band, in any number type; LedBands is the vocabulary outside the kernels.
template <class P>
struct Bands {
    P r{};
    P g{};
    P b{};

    [[nodiscard]] static constexpr Bands all(const P& v) { return {v, v, v}; }
    [[nodiscard]] static constexpr Bands of(const LedBands& bands) {
        return {P(bands[Band::R]), P(bands[Band::G]), P(bands[Band::B])};
    }
    template <class F>
    [[nodiscard]] constexpr auto each(F&& f) const {
        return Bands<decltype(f(r))>{f(r), f(g), f(b)};
    }
    constexpr Bands operator+(const Bands& o) const { return {r + o.r, g + o.g, b + o.b}; }
    constexpr Bands operator*(const Bands& o) const { return {r * o.r, g * o.g, b * o.b}; }
    template <class K>
    constexpr Bands operator*(const K& k) const {
        return {r * k, g * k, b * k};
    }
};

/// The mean of the bands.
template <class P>
[[nodiscard]] double meanOf(const Bands<P>& bands) {
    return static_cast<double>(bands.r + bands.g + bands.b) / 3;
}

template <class P>
[[nodiscard]] LedBands ledBands(const Bands<P>& bands) {
    return {
        {static_cast<double>(bands.r), static_cast<double>(bands.g), static_cast<double>(bands.b)}};
}

template <class T>
constexpr T squared(const T& x) {
    return x * x;
}

/// (1 - c)^5 of Schlick's and Burley's forms.
template <class T>
constexpr T schlickWeight(const T& cosine) {
    const T c = T(1) - cosine;
    const T c2 = c * c;
    return c2 * c2 * c;
}

}  // namespace gonio::proc
