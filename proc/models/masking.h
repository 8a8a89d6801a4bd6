#pragma once
// Masking and shadowing of microfacets [Smith1967] [Heitz2014]: Lambda(w) of a distribution of
// normals, G1 = 1 / (1 + Lambda), and V = G2 / (4 mu_i mu_o), 1/sr, in three forms:
//   height-correlated  G2 = 1 / (1 + Lambda_i + Lambda_o) [Heitz2014, eq. 99]
//   separable          G2 = G1(wi) G1(wo) [Walter2007]
//   fast               V = 0.5 / lerp(2 mu_i mu_o, mu_i + mu_o, alpha): not Smith's, but what
//                      renderers use for it; off by up to 0.16 in directional albedo (GGX only).
// Lambda_ggx = x / (2 (1 + sqrt(1 + x))), x = (alpha tan)^2: the printed (sqrt(1 + x) - 1) / 2
// loses all digits for small x. Lambda_beckmann is the exact (erf(a) - 1) / 2 + exp(-a^2) / (2 a
// sqrt(pi)), a = 1 / (alpha tan), from a = 3 by a continued fraction that has no difference in it;
// at draft effort the rational fit of [Walter2007] (0.35 %). V stays finite for every mu > 0; as mu
// -> 0 it grows like 1/mu, and f mu stays bounded.

#include <concepts>

#include "proc/models/fast_exp.h"
#include "proc/models/kernel.h"
#include "proc/models/normal_distribution.h"

namespace gonio::proc {

enum class Masking {
    HeightCorrelated,
    Separable,
    Fast
};

/// (alpha tan(theta))^2 of a direction; 0 at the normal.
template <class P, class D>
[[nodiscard]] P slope2(const Vec<D>& w, const Alpha<P>& alpha) {
    const P ax = alpha.x * w.x;
    const P ay = alpha.y * w.y;
    return (ax * ax + ay * ay) / (w.z * w.z);
}

template <class P>
[[nodiscard]] P ggxLambda(const P& slope2) {
    using std::sqrt;
    return slope2 / (P(2) * (P(1) + sqrt(P(1) + slope2)));
}

/// mu sqrt(1 + (alpha tan)^2), without a division by mu.
template <class P, class D>
[[nodiscard]] P ggxRoot(const Vec<D>& w, const Alpha<P>& alpha) {
    using std::sqrt;
    const P ax = alpha.x * w.x;
    const P ay = alpha.y * w.y;
    return sqrt(ax * ax + ay * ay + w.z * w.z);
}

template <class P>
struct MaskedCosines {
    P muIn;
    P muOut;
    P rootIn;
    P rootOut;
};

template <class P>
[[nodiscard]] P ggxHeightCorrelatedV(const MaskedCosines<P>& c) {
    return P(0.5) / (c.muOut * c.rootIn + c.muIn * c.rootOut);
}

template <class P>
[[nodiscard]] P ggxSeparableV(const MaskedCosines<P>& c) {
    return P(1) / ((c.muIn + c.rootIn) * (c.muOut + c.rootOut));
}

template <class D>
struct Cosines {
    D in;
    D out;
};

template <class P, class D>
[[nodiscard]] P fastV(const Cosines<D>& mu, const P& alpha) {
    const P rest = P(1) - alpha;
    return P(0.5) / (mu.in * (mu.out * rest + alpha) + mu.out * (mu.in * rest + alpha));
}

template <class P, class D>
[[nodiscard]] P ggxV(const Pair<D>& pair, const Alpha<P>& alpha, Masking masking) {
    using std::sqrt;
    if (masking == Masking::Fast) {
        return fastV(Cosines<D>{pair.in.z, pair.out.z}, P(sqrt(alpha.x * alpha.y)));
    }
    const MaskedCosines<P> c{.muIn = P(pair.in.z),
                             .muOut = P(pair.out.z),
                             .rootIn = ggxRoot(pair.in, alpha),
                             .rootOut = ggxRoot(pair.out, alpha)};
    return masking == Masking::HeightCorrelated ? ggxHeightCorrelatedV(c) : ggxSeparableV(c);
}

/// Exact for x = 1 / (alpha tan) >= 3: with erfc's continued fraction [Abramowitz1972, 7.1.14],
/// sqrt(pi) exp(x^2) erfc(x) = 1 / (x + r), r = (1/2) / (x + 1 / (x + (3/2) / (x + ...))), and
/// 1/x - 1/(x + r) = r / (x (x + r)).
template <class P>
[[nodiscard]] P beckmannLambdaFar(const P& x) {
    using std::exp;
    constexpr int kTerms = 40;  // 1e-16 at x = 3
    P r(0);
    for (int k = kTerms; k >= 1; --k) r = P(0.5 * k) / (x + r);
    return exp(-x * x) * r / (P(2 * std::sqrt(kPi)) * x * (x + r));
}

template <class P>
[[nodiscard]] P exactBeckmannLambda(const P& x) {
    using std::erfc;
    using std::exp;
    if (x >= P(3)) return beckmannLambdaFar(x);
    return exp(-x * x) / (P(2 * std::sqrt(kPi)) * x) - P(0.5) * erfc(x);
}

template <Effort E, class P>
[[nodiscard]] P beckmannLambda(const P& slope2) {
    using std::sqrt;
    constexpr double kSmallestSlope = 1.0 / 27.3;  // exp(-x^2) is 0 beyond in double
    const P least = P(kSmallestSlope * kSmallestSlope);
    const P x = P(1) / sqrt(slope2 > least ? slope2 : least);
    if constexpr (E == Effort::Draft) {
        const P lambda =
            (P(1) - P(1.259) * x + P(0.396) * x * x) / (P(3.535) * x + P(2.181) * x * x);
        return x < P(1.6) ? lambda : P(0);
    } else {
        return slope2 > least ? exactBeckmannLambda(x) : P(0);
    }
}

/// G2 / (4 mu_i mu_o) from Lambda; masking other than Smith's two is the caller's.
template <class P, class D>
[[nodiscard]] P smithV(const Pair<D>& pair, const Cosines<P>& lambda, Masking masking) {
    const P masked = masking == Masking::HeightCorrelated
                         ? P(P(1) + (lambda.in + lambda.out))
                         : P((P(1) + lambda.in) * (P(1) + lambda.out));
    return P(0.25) / (masked * (pair.in.z * pair.out.z));
}

}  // namespace gonio::proc
