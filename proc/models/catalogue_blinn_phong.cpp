#include "proc/models/blinn_phong.h"
#include "proc/models/catalogue.h"
#include "proc/models/kernel_model.h"

namespace gonio::proc {
namespace {

struct BlinnPhongNumbers {
    LedBands kd;
    LedBands ks;
    double n;
    EvalPath path;
};

template <class Power>
Lobe blinnPhongBy(const BlinnPhongNumbers& numbers) {
    return kernelModel<BlinnPhongBy<Power>::template Kernel>(numbers.path, [&]<class P>() {
        return typename BlinnPhongBy<Power>::template Kernel<P>{
            Bands<P>::of(numbers.kd), Bands<P>::of(numbers.ks), static_cast<P>(numbers.n)};
    });
}

struct NamedPower {
    std::string_view name;
    Lobe (*make)(const BlinnPhongNumbers&);
};

template <PowerForm Form>
constexpr NamedPower named(std::string_view name) {
    return {name, blinnPhongBy<PowerOfForm<Form>>};
}

constexpr std::array kPowers{NamedPower{"by-effort", blinnPhongBy<PowerOfEffort>},
                             named<PowerForm::Pow>("pow"),
                             named<PowerForm::Full75>("full75"),
                             named<PowerForm::Full54>("full54"),
                             named<PowerForm::Lite>("lite"),
                             named<PowerForm::Sq8d3>("sq8d3"),
                             named<PowerForm::Sq8>("sq8"),
                             named<PowerForm::Rec3m4>("rec3m4"),
                             named<PowerForm::Rec2m4>("rec2m4"),
                             named<PowerForm::Schlick>("schlick"),
                             named<PowerForm::Bps>("bps"),
                             named<PowerForm::F8>("f8"),
                             named<PowerForm::Quadratic>("quadratic"),
                             named<PowerForm::Cubic>("cubic"),
                             named<PowerForm::Gauss>("gauss"),
                             named<PowerForm::Lagarde>("lagarde")};

Lobe makeBlinnPhong(SpecParameters& p, EvalPath path) {
    std::vector<std::string> names;
    for (const NamedPower& power : kPowers) names.emplace_back(power.name);
    const BlinnPhongNumbers numbers{.kd = p.bands("kd", kShare),
                                    .ks = p.bands("ks", kFactorRange),
                                    .n = p.number("n", {1, 1e6}),
                                    .path = path};
    return kPowers.at(p.choice("power", names)).make(numbers);
}

constexpr std::array kModels{CatalogueEntry{"blinn-phong", makeBlinnPhong}};

}  // namespace

std::span<const CatalogueEntry> blinnPhongModels() { return kModels; }

}  // namespace gonio::proc
