#pragma once
// cos^n of an angle from its cosine and 1 - cosine, at an effort: draft by full54 (3.5e-6 of the
// peak), standard by full75 (1.7e-7), reference and dual numbers by the library. 0 where the cosine
// is not positive.

#include "proc/models/powers.h"

namespace gonio::proc {

/// The cosine of wo against the mirror direction of wi, and 1 minus it as half of their squared
/// distance: exact where the cosine has lost its digits.
template <class D>
[[nodiscard]] NearOne<D> mirrorCosine(const Pair<D>& pair) {
    const D x = pair.out.x + pair.in.x;
    const D y = pair.out.y + pair.in.y;
    const D z = pair.out.z - pair.in.z;
    const D c = pair.out.z * pair.in.z - pair.out.x * pair.in.x - pair.out.y * pair.in.y;
    return {.c = c, .t = (x * x + y * y + z * z) / 2};
}

/// The cosine of the half vector's polar angle.
template <class D>
[[nodiscard]] NearOne<D> halfCosine(const Half<D>& half) {
    return {.c = half.cosTheta(), .t = half.oneMinusCosTheta()};
}

template <Effort E, class P, class D>
[[nodiscard]] P cosinePower(const P& n, const NearOne<D>& x) {
    if constexpr (E == Effort::Reference || !std::floating_point<P>) {
        using std::exp;
        using std::log;
        using std::log1p;
        if (!(x.c > D(0))) return P(0);
        return exp(n * (x.c > D(0.5) ? log1p(-x.t) : log(x.c)));
    } else {
        const P least(std::numeric_limits<P>::min());
        const NearOne<P> positive{.c = std::max(P(x.c), least), .t = P(x.t)};
        const P p = E == Effort::Draft ? power<PowerForm::Full54>(n, positive)
                                       : power<PowerForm::Full75>(n, positive);
        return x.c > D(0) ? p : P(0);
    }
}

}  // namespace gonio::proc
