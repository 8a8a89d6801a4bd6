#pragma once
// The principled model's coat of varnish [Burley2012, sec. 5.5, app. B]:
//   f = strength / 4 GTR1(h; alpha) F V, alpha = 0.1 + (0.001 - 0.1) gloss,
//   F = 0.04 + 0.96 (1 - cos_d)^5, V separable GGX masking of alpha 0.25.
// strength and gloss in [0, 1]; V already holds the 1 / (4 mu_i mu_o), so that the 1/4 is part of
// what `strength` means. Reciprocal; far below 1 in energy (0.25 of a coat of index 1.5).

#include "proc/models/fresnel.h"
#include "proc/models/masking.h"
#include "proc/models/sampling.h"

namespace gonio::proc {

template <class P>
struct Clearcoat {
    P strength;
    P gloss;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        return Bands<P>::all(lobe(pair, Half<D>(pair)));
    }

    [[nodiscard]] LobeMixture lobes() const { return {{0.25 * strength, Gtr1Lobe{alpha()}}}; }

    template <class D>
    [[nodiscard]] P lobe(const Pair<D>& pair, const Half<D>& half) const {
        const HalfSquares<D> squares{half.sin2, half.cos2};
        const D fresnel = schlick(D(0.04), D(1), half.cosDiff);
        const D v = ggxV(pair, Alpha<D>{D(0.25), D(0.25)}, Masking::Separable);
        return strength * P(0.25) * gtr1D(squares, alpha()) * (fresnel * v);
    }

private:
    [[nodiscard]] P alpha() const { return P(0.1) + P(0.001 - 0.1) * gloss; }
};

}  // namespace gonio::proc
