#pragma once
// Fujii's rational Oren-Nayar [Fujii2012], in the form and with the constants of OpenPBR, without
// its energy compensation:
//   f = albedo A / pi (1 + r s / t), A = 1 / (1 + (1/2 - 2/(3 pi)) r),
//   s = wi.wo - mu_i mu_o, t = max(mu_i, mu_o) if s > 0 else 1; r in [0, 1].
// Reciprocal; directional albedo at most `albedo`. At r = 0: Lambert.

#include "proc/models/kernel.h"

namespace gonio::proc {

template <class P>
struct FujiiOrenNayar {
    Bands<P> albedo;
    P r;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const D s = pair.in.x * pair.out.x + pair.in.y * pair.out.y;
        const D t = s > D(0) ? std::max(pair.in.z, pair.out.z) : D(1);
        const P a = P(1) / (P(1) + P(0.5 - 2 / (3 * kPi)) * r);
        // s is at least -1 but for rounding.
        const P shaded = P(1) + r * std::max(D(-1), s / t);
        return albedo * P(a * P(1 / kPi) * shaded);
    }
};

}  // namespace gonio::proc
