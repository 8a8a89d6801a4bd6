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

template <std::size_t... I>
constexpr auto powersByName(std::index_sequence<I...>) {
    return std::array{
        NamedPower{"by-effort", blinnPhongBy<PowerOfEffort>},
        NamedPower{name(kPowerForms[I]), blinnPhongBy<PowerOfForm<kPowerForms[I]>>}...};
}
constexpr auto kPowers = powersByName(std::make_index_sequence<kPowerForms.size()>{});

Lobe makeBlinnPhong(SpecParameters& p, EvalPath path) {
    std::vector<std::string> names;
    names.reserve(kPowers.size());
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
