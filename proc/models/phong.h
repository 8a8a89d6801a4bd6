#pragma once
// Phong's lobe about the mirror direction, alpha being its angle to wo; n >= 0, up to 1e6:
//   phong            f = kd / pi + ks max(0, cos(alpha))^n [Phong1975], as it is usually printed as
//                    a BRDF. Not energy conserving for ks above (n + 2) / (2 pi).
//   lafortune-phong  f = kd / pi + ks (n + 2) / (2 pi) max(0, cos(alpha))^n [LafortuneWillems1994]:
//                    directional albedo at most kd + ks, reached at normal incidence.
// Both reciprocal. (Phong's own formula for radiance has no 1 / cos(theta_i) left in it here.)

#include "proc/models/cosine_lobe.h"
#include "proc/models/sampling.h"

namespace gonio::proc {

template <class P>
struct Phong {
    Bands<P> kd;
    Bands<P> ks;
    P n;

    static constexpr bool kByEffort = true;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        return kd * P(1 / kPi) + ks * cosinePower<E>(n, mirrorCosine(pair));
    }

    [[nodiscard]] LobeMixture lobes() const {
        // Of the lobe's albedo at normal incidence.
        return {{meanOf(kd), CosineLobe{}}, {meanOf(ks) * 2 * kPi / (n + 2), MirrorPowerLobe{n}}};
    }
};

template <class P>
struct LafortunePhong {
    Bands<P> kd;
    Bands<P> ks;
    P n;

    static constexpr bool kByEffort = true;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const P norm = (n + P(2)) * P(1 / (2 * kPi));
        return kd * P(1 / kPi) + ks * P(norm * cosinePower<E>(n, mirrorCosine(pair)));
    }

    [[nodiscard]] LobeMixture lobes() const {
        return {{meanOf(kd), CosineLobe{}}, {meanOf(ks), MirrorPowerLobe{n}}};
    }
};

}  // namespace gonio::proc
