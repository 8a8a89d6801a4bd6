#include "proc/models/catalogue.h"
#include "proc/models/cod_wwii_diffuse.h"
#include "proc/models/disney_diffuse.h"
#include "proc/models/frostbite_diffuse.h"
#include "proc/models/fujii_oren_nayar.h"
#include "proc/models/kernel_model.h"
#include "proc/models/lambert.h"
#include "proc/models/oren_nayar.h"

namespace gonio::proc {
namespace {

Lobe makeLambert(SpecParameters& p, EvalPath path) {
    const LedBands albedo = p.bands("albedo", kShare);
    return kernelModel<Lambert>(path, [&]<class P>() { return Lambert<P>{Bands<P>::of(albedo)}; });
}

/// A diffuse model of an albedo and one more number.
template <template <class> class Kernel>
Lobe makeDiffuse(SpecParameters& p, EvalPath path, const std::string& key, ValueRange range) {
    const LedBands albedo = p.bands("albedo", kShare);
    const double value = p.number(key, range);
    return kernelModel<Kernel>(path, [&]<class P>() {
        return Kernel<P>{Bands<P>::of(albedo), static_cast<P>(value)};
    });
}

Lobe makeOrenNayar(SpecParameters& p, EvalPath path) {
    return makeDiffuse<OrenNayar>(p, path, "sigma", {0, kPi / 2});
}
Lobe makeFujiiOrenNayar(SpecParameters& p, EvalPath path) {
    return makeDiffuse<FujiiOrenNayar>(p, path, "r", kShare);
}
Lobe makeDisneyDiffuse(SpecParameters& p, EvalPath path) {
    return makeDiffuse<DisneyDiffuse>(p, path, "roughness", kShare);
}
Lobe makeFrostbiteDiffuse(SpecParameters& p, EvalPath path) {
    return makeDiffuse<FrostbiteDiffuse>(p, path, "roughness", kShare);
}
Lobe makeCodWwiiDiffuse(SpecParameters& p, EvalPath path) {
    return makeDiffuse<CodWwiiDiffuse>(p, path, "alpha", kAlphaRange);
}

constexpr std::array kModels{CatalogueEntry{"lambert", makeLambert},
                             CatalogueEntry{"oren-nayar", makeOrenNayar},
                             CatalogueEntry{"fujii-oren-nayar", makeFujiiOrenNayar},
                             CatalogueEntry{"disney-diffuse", makeDisneyDiffuse},
                             CatalogueEntry{"frostbite-diffuse", makeFrostbiteDiffuse},
                             CatalogueEntry{"cod-wwii-diffuse", makeCodWwiiDiffuse}};

}  // namespace

std::span<const CatalogueEntry> diffuseModels() { return kModels; }

}  // namespace gonio::proc
