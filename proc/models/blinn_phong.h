#pragma once
// Blinn's lobe about the half vector [Blinn1977], with the normalisation of renderers:
//   f = kd / pi + ks (n + 8) / (8 pi) (n.h)^n, n in [1, 1e6].
// The power is one of the forms of powers.h; without one, that of the effort. Reciprocal.
// Directional albedo of the lobe: 1.075 ks at the most (n = 8, normal incidence), less at other n
// and toward grazing: not strictly energy conserving. The published forms keep their faults (bps is
// negative in places: cut at 0 here, as f may not be).

#include "proc/models/cosine_lobe.h"
#include "proc/models/sampling.h"

namespace gonio::proc {

struct PowerOfEffort {
    static constexpr bool kByEffort = true;

    template <Effort E, class P, class D>
    [[nodiscard]] static P of(const P& n, const NearOne<D>& x) {
        return cosinePower<E>(n, x);
    }
};

template <PowerForm Form>
struct PowerOfForm {
    static constexpr bool kByEffort = false;

    template <Effort E, class P, class D>
    [[nodiscard]] static P of(const P& n, const NearOne<D>& x) {
        return std::max(P(0), power<Form>(n, x));
    }
};

template <class Power>
struct BlinnPhongBy {
    template <class P>
    struct Kernel {
        Bands<P> kd;
        Bands<P> ks;
        P n;

        static constexpr bool kByEffort = Power::kByEffort;

        template <Effort E, class D>
        [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
            const P norm = (n + P(8)) * P(1 / (8 * kPi));
            const P lobe = Power::template of<E>(n, halfCosine(Half<D>(pair)));
            return kd * P(1 / kPi) + ks * P(norm * lobe);
        }

        [[nodiscard]] LobeMixture lobes() const {
            return {{meanOf(kd), CosineLobe{}}, {meanOf(ks), HalfPowerLobe{n}}};
        }
    };
};

template <class P>
using BlinnPhong = BlinnPhongBy<PowerOfEffort>::Kernel<P>;

}  // namespace gonio::proc
