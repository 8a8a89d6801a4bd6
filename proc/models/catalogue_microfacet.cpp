#include "proc/models/alpha_parameters.h"
#include "proc/models/beckmann.h"
#include "proc/models/ggx.h"
#include "proc/models/gtr.h"
#include "proc/models/kernel_model.h"
#include "proc/models/multiple_scattering.h"
#include "proc/models/tabulated.h"
#include "proc/models/walter.h"

namespace gonio::proc {
namespace {

template <class P>
Alpha<P> as(const AlphaNumbers& alpha) {
    return {static_cast<P>(alpha.x), static_cast<P>(alpha.y)};
}

struct GgxNumbers {
    AlphaNumbers alpha;
    FresnelNumbers fresnel;
    Masking masking;

    template <class P>
    [[nodiscard]] Ggx<P> kernel() const {
        return {as<P>(alpha), fresnel.as<P>(), masking};
    }
};

Lobe withMultipleScattering(const GgxNumbers& numbers, MultipleScattering how, EvalPath path) {
    const double alpha = std::sqrt(numbers.alpha.x * numbers.alpha.y);
    const auto curve = std::make_shared<const AlbedoCurve>(alpha);
    const LedBands average = averageFresnel(numbers.fresnel.as<double>());
    return kernelModel<GgxMultiple>(path, [&]<class P>() {
        return GgxMultiple<P>{numbers.kernel<P>(), how, Bands<P>::of(average), curve};
    });
}

Lobe makeGgx(SpecParameters& p, EvalPath path) {
    const GgxNumbers numbers{.alpha = alphaOf(p),
                             .fresnel = fresnelOf(p),
                             .masking = static_cast<Masking>(
                                 p.choice("masking", {"height-correlated", "separable", "fast"}))};
    const std::size_t bounces = p.choice("multiscatter", {"none", "kulla-conty", "fdez-aguera"});
    if (bounces == 0) {
        return kernelModel<Ggx>(path, [&]<class P>() { return numbers.kernel<P>(); });
    }
    if (numbers.masking != Masking::HeightCorrelated) {
        p.complain("multiscatter needs masking=height-correlated, whose albedo it restores");
    }
    const auto how = static_cast<MultipleScattering>(bounces - 1);
    if (how == MultipleScattering::FdezAguera && numbers.fresnel.form != FresnelForm::Schlick) {
        p.complain("multiscatter=fdez-aguera needs fresnel=schlick; kulla-conty takes both");
    }
    return withMultipleScattering(numbers, how, path);
}

Lobe makeBeckmann(SpecParameters& p, EvalPath path) {
    const AlphaNumbers alpha = alphaOf(p);
    const FresnelNumbers fresnel = fresnelOf(p);
    const std::size_t form = p.choice("masking", {"height-correlated", "separable", "fast"});
    const auto masking = static_cast<Masking>(form);
    if (masking == Masking::Fast) p.complain("masking=fast is GGX's alone");
    if (p.choice("multiscatter", {"none", "kulla-conty", "fdez-aguera"}) != 0) {
        p.complain("multiscatter is for ggx alone, whose albedo it knows");
    }
    return kernelModel<Beckmann>(path, [&]<class P>() {
        return Beckmann<P>{as<P>(alpha), fresnel.as<P>(), masking};
    });
}

Lobe makeGtr(SpecParameters& p, EvalPath path) {
    const double alpha = p.number("alpha", kAlphaRange);
    const double gamma = p.number("gamma", {0.5, 10});
    const FresnelNumbers fresnel = fresnelOf(p);
    return kernelModel<Gtr>(path, [&]<class P>() {
        return Gtr<P>{static_cast<P>(alpha),
                      static_cast<P>(gamma),
                      static_cast<P>(gtrPeak(alpha, gamma)),
                      fresnel.as<P>()};
    });
}

Lobe makeWalter(SpecParameters& p, EvalPath path) {
    const double alpha = p.number("alpha", kAlphaRange);
    const LedBands eta = p.bands("eta", kIndexRange);
    return kernelModel<Walter>(path, [&]<class P>() {
        return Walter<P>{static_cast<P>(alpha), Bands<P>::of(eta)};
    });
}

Lobe makeTabulated(SpecParameters& p, EvalPath path) {
    const std::string file = p.text("F");
    const LedBands f0 = p.bandsOr("f0", kShare, 1);
    const Result<NormalTable> table = NormalTable::read(file);
    if (!table) {
        p.refuse(table.error());
        return nullptr;
    }
    const auto shared = std::make_shared<const NormalTable>(*table);
    return kernelModel<Tabulated>(path, [&]<class P>() {
        return Tabulated<P>{shared, Bands<P>::of(f0)};
    });
}

constexpr std::array kModels{CatalogueEntry{"ggx", makeGgx},
                             CatalogueEntry{"beckmann", makeBeckmann},
                             CatalogueEntry{"gtr", makeGtr},
                             CatalogueEntry{"walter", makeWalter},
                             CatalogueEntry{"tabulated", makeTabulated}};

}  // namespace

std::span<const CatalogueEntry> microfacetModels() { return kModels; }

}  // namespace gonio::proc
