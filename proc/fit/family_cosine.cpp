#include "proc/fit/family_kernel.h"
#include "proc/models/blinn_phong.h"
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

/// n is about 2 / alpha^2 for Blinn's lobe, half a power less than a half for Phong's.
template <template <class> class Kernel>
void add(FamilyList& list, std::string_view name, double mostKs) {
    const FamilyParameter n{.name = "n",
                            .unit = "1",
                            .lower = 1,
                            .upper = 8e4,
                            .scale = ParameterScale::Log,
                            .starts = {2, 6, 20, 60, 200, 800, 4000, 2e4}};
    const FamilyParameter kd{.name = "kd", .unit = "1", .perBand = true, .starts = {0.2}};
    const FamilyParameter ks{
        .name = "ks", .unit = "1", .upper = mostKs, .perBand = true, .starts = {0.1}};
    list.push_back(std::make_unique<KernelFamily<PhongLobes<Kernel>>>(
        std::string(name),
        std::vector<FamilyLobe>{{name}},
        std::vector<FamilyParameter>{n, kd, ks}));
}

}  // namespace

void addCosineFamilies(FamilyList& list) {
    add<Phong>(list, "phong", 1e5);  // the printed lobe's peak: ks itself, in 1/sr
    add<LafortunePhong>(list, "lafortune-phong", 10);
    add<BlinnPhong>(list, "blinn-phong", 10);
}

}  // namespace gonio::proc
