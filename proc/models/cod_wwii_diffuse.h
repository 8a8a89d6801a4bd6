#pragma once
// The diffuse reflection of rough surfaces as fitted for Call of Duty: WWII [Chan2018]: a blend of
// a smooth and a rough diffuse lobe and a retro-reflection,
//   g = clamp(log2(2 / alpha^2 - 1) / 18, 0, 1), F0 = d + (1 - d)^5, d = cos(theta_d),
//   F1 = (1 - 0.75 (1 - mu_i)^5)(1 - 0.75 (1 - mu_o)^5),
//   Fd = F0 + (F1 - F0) clamp(2.2 g - 0.5, 0, 1),
//   Fb = ((34.5 g - 59) g + 24.5) d 2^(-max(73.2 g - 21.2, 8.9) sqrt(cos(theta_h))),
//   f = albedo (Fd + Fb) / pi.
// alpha in [1e-7, 1]. Reciprocal. Not energy conserving: directional albedo for albedo 1 is
// 0.31..1.158, the most at grazing, alpha 1.

#include "proc/models/fast_exp.h"
#include "proc/models/kernel.h"

namespace gonio::proc {

/// With what depends on alpha alone, g and the two numbers made of it, worked out before a loop.
template <class P>
struct CodWwiiOfGloss {
    Bands<P> albedo;
    P smooth;  ///< clamp(2.2 g - 0.5, 0, 1)
    P retro;   ///< (34.5 g - 59) g + 24.5
    P rate;    ///< max(73.2 g - 21.2, 8.9) ln 2

    static constexpr bool kByEffort = true;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const Half<D> half(pair);
        const D d = half.cosDiff;
        const D f0 = d + schlickWeight(d);
        const D f1 = (D(1) - D(0.75) * schlickWeight(pair.in.z)) *
                     (D(1) - D(0.75) * schlickWeight(pair.out.z));
        const P fd = f0 + (f1 - f0) * smooth;
        const P fb = retro * d * expOf<E>(P(-rate * std::sqrt(half.cosTheta())));
        return albedo * P((fd + fb) * P(1 / kPi));
    }
};

template <class P>
struct CodWwiiDiffuse {
    Bands<P> albedo;
    P alpha;

    static constexpr bool kByEffort = true;

    template <class Call>
    auto withForms(Call&& call) const {
        using std::log2;
        const auto clamped = [](const P& x) { return x < P(0) ? P(0) : x > P(1) ? P(1) : x; };
        const P g = clamped(log2(P(2) / (alpha * alpha) - P(1)) * P(1.0 / 18));
        const P steep = P(73.2) * g - P(21.2);
        return call(
            CodWwiiOfGloss<P>{.albedo = albedo,
                              .smooth = clamped(P(2.2) * g - P(0.5)),
                              .retro = (P(34.5) * g - P(59)) * g + P(24.5),
                              .rate = (steep > P(8.9) ? steep : P(8.9)) * P(0.69314718055994531)});
    }

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        return withForms([&](const auto& fixed) { return fixed.template f<E>(pair); });
    }
};

}  // namespace gonio::proc
