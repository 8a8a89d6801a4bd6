#include "proc/fit/family_kernel.h"
#include "proc/models/blinn_phong.h"
#include "proc/models/lafortune.h"
#include "proc/models/lambert.h"
#include "proc/models/phong.h"

namespace gonio::proc {
namespace {

template <template <class> class Kernel>
struct PhongLobes {
    static constexpr int kShared = 1;
    static constexpr int kPerBand = 2;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return Kernel<P>{perBand[0], perBand[1], shared[0]};
    }
};

/// With cxy = -1, as the lobe depends on the ratio of the two alone.
struct LafortuneLobes {
    static constexpr int kShared = 2;
    static constexpr int kPerBand = 2;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return BothKernels{Lambert<P>{perBand[0]},
                           Lafortune<P>{perBand[1], P(-1), shared[1], shared[0]}};
    }
};

/// n is about 2 / alpha^2 for Blinn's lobe, 1 / (2 alpha^2) for one about the mirror direction.
FamilyParameter exponent(std::size_t lobe = 0) {
    return {.name = "n",
            .lobe = lobe,
            .unit = "1",
            .lower = 1,
            .upper = 8e4,
            .scale = ParameterScale::Log,
            .starts = {2, 6, 20, 60, 200, 800, 4000, 2e4}};
}

template <template <class> class Kernel>
void add(FamilyList& list, std::string_view name, std::string_view ksUnit, double mostKs) {
    const FamilyParameter kd{.name = "kd", .unit = "1", .perBand = true, .starts = {0.2}};
    const FamilyParameter ks{
        .name = "ks", .unit = ksUnit, .upper = mostKs, .perBand = true, .starts = {0.1}};
    list.push_back(std::make_unique<KernelFamily<PhongLobes<Kernel>>>(
        std::string(name),
        std::vector<FamilyLobe>{{name}},
        std::vector<FamilyParameter>{exponent(), kd, ks}));
}

}  // namespace

void addCosineFamilies(FamilyList& list) {
    add<Phong>(list, "phong", "1/sr", 1e5);  // of the printed lobe ks is the peak
    add<LafortunePhong>(list, "lafortune-phong", "1", 10);
    add<BlinnPhong>(list, "blinn-phong", "1", 10);
    namespace fp = family_parameters;
    const FamilyParameter lean{
        .name = "cz", .lobe = 1, .unit = "1", .upper = 10, .starts = {0.3, 0.9, 1, 1.2, 3}};
    list.push_back(std::make_unique<KernelFamily<LafortuneLobes>>(
        "lambert+lafortune",
        std::vector<FamilyLobe>{{"lambert"}, {"lafortune", "cxy=-1"}},
        std::vector<FamilyParameter>{exponent(1), lean, fp::albedo(), fp::ks()}));
}

}  // namespace gonio::proc
