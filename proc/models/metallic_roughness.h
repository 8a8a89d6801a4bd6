#pragma once
// glTF 2.0's metallic-roughness material [Gltf2021, app. B] with its extensions for clearcoat and
// anisotropy, all parameters in [0, 1]:
//   f_base = (1 - F) (1 - metallic) base / pi + D_ggx V F, alpha = roughness^2 (at least 1e-7),
//   F by Schlick from f0 = lerp(0.04, base, metallic), V separable;
//   f = lerp(f_base, D_ggx V of the coat, clearcoat F_coat), F_coat by Schlick from 0.04 and mu_o.
// Anisotropy a: alpha_x = lerp(alpha, 1, a^2), alpha_y = alpha (the extension's sample code masks
// height-correlated and cuts V at 1; here V is the base's, so that a = 0 is the base).
// Reciprocal without a coat; with one it is not, as the coat's F looks at mu_o alone. Energy: a
// metal at most 1; a white dielectric 1.05 at 75 degrees and 1.12 at grazing (roughness 0.5), 1.19
// and 1.5 (0.2): its diffuse part loses F of the half vector's angle, not of what the lobe
// reflects.

#include "proc/models/ggx.h"
#include "proc/models/sampling.h"

namespace gonio::proc {

template <class P>
struct MetallicRoughness {
    Bands<P> base;
    P metallic;
    P roughness;
    P clearcoat;
    P clearcoatRoughness;
    P anisotropy;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const Half<D> half(pair);
        const P lobe = lobeOf(baseAlpha(), pair, half);
        const P coat = lobeOf(coatAlpha(), pair, half);
        const P coated = clearcoat * schlick(D(0.04), D(1), pair.out.z);
        const D weight = schlickWeight(half.cosDiff);
        return base.each([&](const P& c) {
            const P f0 = P(0.04) + (c - P(0.04)) * metallic;
            const P fresnel = f0 + (P(1) - f0) * weight;
            const P diffuse = (P(1) - metallic) * c * P(1 / kPi);
            const P below = (P(1) - fresnel) * diffuse + fresnel * lobe;
            return P(below + (coat - below) * coated);
        });
    }

    [[nodiscard]] LobeMixture lobes() const {
        return {{1 - metallic, CosineLobe{}},
                {0.1 + metallic, GgxLobe{baseAlpha()}},
                {0.1 * clearcoat, GgxLobe{coatAlpha()}}};
    }

private:
    [[nodiscard]] Alpha<P> baseAlpha() const {
        const P plain = alphaOf(roughness);
        return {plain + (P(1) - plain) * anisotropy * anisotropy, plain};
    }
    [[nodiscard]] Alpha<P> coatAlpha() const {
        return Alpha<P>::isotropic(alphaOf(clearcoatRoughness));
    }
    static P alphaOf(const P& roughness) {
        const P alpha = roughness * roughness;
        return alpha > P(1e-7) ? alpha : P(1e-7);
    }
    template <class D>
    static P lobeOf(const Alpha<P>& alpha, const Pair<D>& pair, const Half<D>& half) {
        return ggxD(half, alpha) * ggxV(pair, alpha, Masking::Separable);
    }
};

}  // namespace gonio::proc
