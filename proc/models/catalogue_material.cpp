#include "proc/models/catalogue.h"
#include "proc/models/clearcoat.h"
#include "proc/models/disney.h"
#include "proc/models/kernel_model.h"
#include "proc/models/metallic_roughness.h"

namespace gonio::proc {
namespace {

Lobe makeClearcoat(SpecParameters& p, EvalPath path) {
    const double strength = p.number("strength", kShare);
    const double gloss = p.number("gloss", kShare);
    return kernelModel<Clearcoat>(path, [&]<class P>() {
        return Clearcoat<P>{static_cast<P>(strength), static_cast<P>(gloss)};
    });
}

Lobe makeDisney(SpecParameters& p, EvalPath path) {
    const LedBands base = p.bands("base", kShare);
    // In the kernel's order, with Burley's defaults.
    const std::array numbers{p.numberOr("metallic", kShare, 0),
                             p.numberOr("subsurface", kShare, 0),
                             p.numberOr("specular", kShare, 0.5),
                             p.numberOr("specular_tint", kShare, 0),
                             p.numberOr("roughness", kShare, 0.5),
                             p.numberOr("anisotropic", kShare, 0),
                             p.numberOr("sheen", kShare, 0),
                             p.numberOr("sheen_tint", kShare, 0.5),
                             p.numberOr("clearcoat", kShare, 0),
                             p.numberOr("clearcoat_gloss", kShare, 1)};
    return kernelModel<Disney>(path, [&]<class P>() {
        const auto n = [&](std::size_t i) { return static_cast<P>(numbers.at(i)); };
        return Disney<P>{.base = Bands<P>::of(base),
                         .metallic = n(0),
                         .subsurface = n(1),
                         .specular = n(2),
                         .specularTint = n(3),
                         .roughness = n(4),
                         .anisotropic = n(5),
                         .sheen = n(6),
                         .sheenTint = n(7),
                         .clearcoat = n(8),
                         .clearcoatGloss = n(9)};
    });
}

Lobe makeMetallicRoughness(SpecParameters& p, EvalPath path) {
    const LedBands base = p.bands("base", kShare);
    const double metallic = p.number("metallic", kShare);
    const double roughness = p.number("roughness", kShare);
    const double clearcoat = p.numberOr("clearcoat", kShare, 0);
    const double clearcoatRoughness = p.numberOr("clearcoat_roughness", kShare, 0);
    const double anisotropy = p.numberOr("anisotropy", kShare, 0);
    return kernelModel<MetallicRoughness>(path, [&]<class P>() {
        return MetallicRoughness<P>{.base = Bands<P>::of(base),
                                    .metallic = static_cast<P>(metallic),
                                    .roughness = static_cast<P>(roughness),
                                    .clearcoat = static_cast<P>(clearcoat),
                                    .clearcoatRoughness = static_cast<P>(clearcoatRoughness),
                                    .anisotropy = static_cast<P>(anisotropy)};
    });
}

constexpr std::array kModels{CatalogueEntry{"clearcoat", makeClearcoat},
                             CatalogueEntry{"disney", makeDisney},
                             CatalogueEntry{"metallic-roughness", makeMetallicRoughness}};

}  // namespace

std::span<const CatalogueEntry> materialModels() { return kModels; }

}  // namespace gonio::proc
