#pragma once
// Lafortune's generalised cosine lobe [Lafortune1997, eq. 4], isotropic, with the normalisation of
// [Ngan2005]:
//   f = ks (n + 2) / (2 pi) max(0, a (xi xo + yi yo) + b zi zo)^n, (a, b) = (cxy, cz) / max(|cxy|,
//   |cz|).
// cxy = -1, cz = 1 is the lobe of lafortune-phong; |cxy| > cz leans it off the mirror direction.
// Not both zero; n in [0, 1e6]. Reciprocal. Directional albedo at most ks. 1 minus the base is
// summed of squares, so that a sharp lobe keeps its digits.

#include "proc/models/cosine_lobe.h"
#include "proc/models/sampling.h"

namespace gonio::proc {

template <class P>
struct Lafortune {
    Bands<P> ks;
    P cxy;
    P cz;
    P n;

    static constexpr bool kByEffort = true;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        using std::abs;
        const P size = abs(cxy) > abs(cz) ? abs(cxy) : abs(cz);
        const P a = cxy / size;
        const P b = cz / size;
        const Vec<D>& i = pair.in;
        const Vec<D>& o = pair.out;
        const P gap = squared(o.x - a * i.x) + squared(o.y - a * i.y) + squared(o.z - b * i.z) +
                      (P(1) - a * a) * (i.x * i.x + i.y * i.y) + (P(1) - b * b) * (i.z * i.z);
        const P c = a * (i.x * o.x + i.y * o.y) + b * (i.z * o.z);
        const NearOne<P> x{.c = c, .t = gap * P(0.5)};
        const P norm = (n + P(2)) * P(1 / (2 * kPi));
        return ks * P(norm * cosinePower<E>(n, x));
    }

    /// About the mirror direction, from which the lobe leans less than its width for what is
    /// fitted.
    [[nodiscard]] LobeMixture lobes() const {
        return {{meanOf(ks), MirrorPowerLobe{n}}, {0.1 * meanOf(ks), CosineLobe{}}};
    }
};

}  // namespace gonio::proc
