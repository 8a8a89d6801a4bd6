#pragma once
// Disney's principled reflectance [Burley2012, app. B], all parameters in [0, 1]:
//   f = (1 - metallic) (base / pi ((1 - s) fd + s ss) + sheen Fh tint_sheen)
//       + D_ggx,aniso V F + clearcoat,
// fd the diffuse of disney_diffuse.h, ss Hanrahan and Krueger's subsurface in its form, Fh =
// (1 - cos_d)^5. alpha_x = max(0.001, r^2 / q), alpha_y = max(0.001, r^2 q), q = sqrt(1 - 0.9
// anisotropic). F by Schlick from f0 = specular 0.08 lerp(1, tint, specular_tint), `base` for
// metals. base is linear (Burley's code takes it as sRGB); the luminance for tints is 0.3 r + 0.6 g
// + 0.1 b. Reciprocal. Not energy conserving: its
// diffuse alone reaches 1.558 at grazing, with sheen a grey one 1.71, and a saturated one, whose
// tint is its colour over its luminance, 2.4.

#include "proc/models/burley_diffuse.h"
#include "proc/models/clearcoat.h"
#include "proc/models/masking.h"

namespace gonio::proc {

template <class P>
struct Disney {
    Bands<P> base;
    P metallic;
    P subsurface;
    P specular;
    P specularTint;
    P roughness;
    P anisotropic;
    P sheen;
    P sheenTint;
    P clearcoat;
    P clearcoatGloss;

    template <Effort E, class D>
    [[nodiscard]] Bands<P> f(const Pair<D>& pair) const {
        const Half<D> half(pair);
        const D grazing = schlickWeight(half.cosDiff);
        const Bands<P> tint = tintOf(base);
        const Bands<P> sheenColour =
            tint.each([&](const P& c) { return P(lerp(P(1), c, sheenTint) * sheen * grazing); });
        const Bands<P> diffuse =
            base * P(diffuseFactor(pair, half.cosDiff) * P(1 / kPi)) + sheenColour;
        const P coat = Clearcoat<P>{clearcoat, clearcoatGloss}.lobe(pair, half);
        return diffuse * P(P(1) - metallic) + specularLobe(pair, half, tint) + Bands<P>::all(coat);
    }

    [[nodiscard]] LobeMixture lobes() const {
        LobeMixture all = Clearcoat<P>{clearcoat, clearcoatGloss}.lobes();
        all.push_back({1 - metallic, CosineLobe{}});
        all.push_back({0.1 + metallic, GgxLobe{alphaOf()}});
        return all;
    }

private:
    static P lerp(const P& from, const P& to, const P& share) { return from + (to - from) * share; }

    [[nodiscard]] Alpha<P> alphaOf() const {
        using std::sqrt;
        const P aspect = sqrt(P(1) - P(0.9) * anisotropic);
        const P a = roughness * roughness;
        const auto atLeast = [](const P& x) { return x > P(0.001) ? x : P(0.001); };
        return {atLeast(a / aspect), atLeast(a * aspect)};
    }

    static Bands<P> tintOf(const Bands<P>& base) {
        const P luminance = P(0.3) * base.r + P(0.6) * base.g + P(0.1) * base.b;
        if (!(luminance > P(0))) return Bands<P>::all(P(1));
        return base.each([&](const P& c) { return P(c / luminance); });
    }

    template <class D>
    [[nodiscard]] P diffuseFactor(const Pair<D>& pair, const D& cosDiff) const {
        const P retro = roughness * (cosDiff * cosDiff);
        const P plain = burleyFactor(P(P(0.5) + P(2) * retro), pair);
        const D both = pair.in.z + pair.out.z;
        const P under = P(1.25) * (burleyFactor(retro, pair) * (D(1) / both - D(0.5)) + P(0.5));
        return lerp(plain, under, subsurface);
    }

    template <class D>
    [[nodiscard]] Bands<P> specularLobe(const Pair<D>& pair,
                                        const Half<D>& half,
                                        const Bands<P>& tint) const {
        const Alpha<P> alpha = alphaOf();
        const P lobe = ggxD(half, alpha) * ggxV(pair, alpha, Masking::Separable);
        const D weight = schlickWeight(half.cosDiff);
        const auto one = [&](const P& baseBand, const P& tintBand) {
            const P plain = specular * P(0.08) * lerp(P(1), tintBand, specularTint);
            const P f0 = lerp(plain, baseBand, metallic);
            return P(f0 + (P(1) - f0) * weight);
        };
        const Bands<P> fresnel{one(base.r, tint.r), one(base.g, tint.g), one(base.b, tint.b)};
        return fresnel * lobe;
    }
};

}  // namespace gonio::proc
