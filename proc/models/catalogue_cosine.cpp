#include "proc/models/catalogue.h"
#include "proc/models/kernel_model.h"
#include "proc/models/lafortune.h"
#include "proc/models/phong.h"

namespace gonio::proc {
namespace {

template <template <class> class Kernel>
Lobe makePhongLike(SpecParameters& p, EvalPath path) {
    const LedBands kd = p.bands("kd", kShare);
    const LedBands ks = p.bands("ks", kFactorRange);
    const double n = p.number("n", kExponentRange);
    return kernelModel<Kernel>(path, [&]<class P>() {
        return Kernel<P>{Bands<P>::of(kd), Bands<P>::of(ks), static_cast<P>(n)};
    });
}

Lobe makePhong(SpecParameters& p, EvalPath path) { return makePhongLike<Phong>(p, path); }
Lobe makeLafortunePhong(SpecParameters& p, EvalPath path) {
    return makePhongLike<LafortunePhong>(p, path);
}

Lobe makeLafortune(SpecParameters& p, EvalPath path) {
    constexpr ValueRange kLean{-1e3, 1e3};
    const double cxy = p.number("cxy", kLean);
    const double cz = p.number("cz", kLean);
    const double n = p.number("n", kExponentRange);
    const LedBands ks = p.bandsOr("ks", kFactorRange, 1);
    if (std::abs(cxy) < 1e-6 && std::abs(cz) < 1e-6) p.complain("cxy and cz are both 0");
    return kernelModel<Lafortune>(path, [&]<class P>() {
        return Lafortune<P>{
            Bands<P>::of(ks), static_cast<P>(cxy), static_cast<P>(cz), static_cast<P>(n)};
    });
}

constexpr std::array kModels{CatalogueEntry{"phong", makePhong},
                             CatalogueEntry{"lafortune-phong", makeLafortunePhong},
                             CatalogueEntry{"lafortune", makeLafortune}};

}  // namespace

std::span<const CatalogueEntry> cosineModels() { return kModels; }

}  // namespace gonio::proc
