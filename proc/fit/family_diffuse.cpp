#include "proc/fit/family_kernel.h"
#include "proc/models/cod_wwii_diffuse.h"
#include "proc/models/disney_diffuse.h"
#include "proc/models/frostbite_diffuse.h"
#include "proc/models/fujii_oren_nayar.h"
#include "proc/models/lambert.h"
#include "proc/models/oren_nayar.h"

namespace gonio::proc {
namespace {

namespace fp = family_parameters;

struct LambertLobes {
    static constexpr int kShared = 0;
    static constexpr int kPerBand = 1;
    template <class P>
    static auto kernel(const P*, const Bands<P>* perBand) {
        return Lambert<P>{perBand[0]};
    }
};

/// A diffuse kernel of an albedo and one more number.
template <template <class> class Kernel>
struct DiffuseLobes {
    static constexpr int kShared = 1;
    static constexpr int kPerBand = 1;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return Kernel<P>{perBand[0], shared[0]};
    }
};

template <template <class> class Kernel>
void add(FamilyList& list, std::string_view name, FamilyParameter shape) {
    list.push_back(std::make_unique<KernelFamily<DiffuseLobes<Kernel>>>(
        std::string(name),
        std::vector<FamilyLobe>{{name}},
        std::vector<FamilyParameter>{std::move(shape), fp::albedo()}));
}

}  // namespace

void addDiffuseFamilies(FamilyList& list) {
    list.push_back(
        std::make_unique<KernelFamily<LambertLobes>>("lambert",
                                                     std::vector<FamilyLobe>{{"lambert"}},
                                                     std::vector<FamilyParameter>{fp::albedo()}));
    const FamilyParameter share{.name = "roughness", .unit = "1", .starts = {0.1, 0.5, 0.9}};
    add<OrenNayar>(
        list,
        "oren-nayar",
        {.name = "sigma", .unit = "rad", .upper = kPi / 2, .starts = {0.1, 0.3, 0.6, 1.1}});
    add<FujiiOrenNayar>(
        list, "fujii-oren-nayar", {.name = "r", .unit = "1", .starts = {0.1, 0.5, 0.9}});
    add<DisneyDiffuse>(list, "disney-diffuse", share);
    add<FrostbiteDiffuse>(list, "frostbite-diffuse", share);
    add<CodWwiiDiffuse>(list, "cod-wwii-diffuse", fp::width("alpha"));
}

}  // namespace gonio::proc
