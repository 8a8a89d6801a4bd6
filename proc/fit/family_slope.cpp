#include "proc/fit/family_kernel.h"
#include "proc/models/cook_torrance.h"
#include "proc/models/lambert.h"
#include "proc/models/ward.h"
#include "proc/models/ward_averaged.h"

namespace gonio::proc {
namespace {

namespace fp = family_parameters;

struct WardLobes {
    static constexpr int kShared = 1;
    static constexpr int kPerBand = 2;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return BothKernels{Lambert<P>{perBand[0]},
                           Ward<P>{perBand[1], Alpha<P>::isotropic(shared[0]), WardNorm::Ward1992}};
    }
};

struct AnisotropicWardLobes {
    static constexpr int kShared = 2;
    static constexpr int kPerBand = 2;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return BothKernels{Lambert<P>{perBand[0]},
                           Ward<P>{perBand[1], {shared[0], shared[1]}, WardNorm::Ward1992}};
    }
};

struct AveragedWardLobes {
    static constexpr int kShared = 2;
    static constexpr int kPerBand = 2;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return BothKernels{Lambert<P>{perBand[0]},
                           WardAveraged<P>{perBand[1], {shared[0], shared[1]}}};
    }
};

struct CookTorranceLobes {
    static constexpr int kShared = 1;
    static constexpr int kPerBand = 2;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return BothKernels{Lambert<P>{perBand[0]},
                           CookTorrance<P>{shared[0], perBand[1], Bands<P>::all(P(1))}};
    }
};

FamilyParameter ks() {
    return {.name = "ks", .lobe = 1, .unit = "1", .upper = 10, .perBand = true, .starts = {0.1}};
}

}  // namespace

void addSlopeFamilies(FamilyList& list) {
    using Lobes = std::vector<FamilyLobe>;
    using Parameters = std::vector<FamilyParameter>;
    list.push_back(std::make_unique<KernelFamily<WardLobes>>(
        "lambert+ward",
        Lobes{{"lambert"}, {"ward"}},
        Parameters{fp::width("alpha", 1), fp::albedo(), ks()}));
    list.push_back(std::make_unique<KernelFamily<CookTorranceLobes>>(
        "lambert+cook-torrance",
        Lobes{{"lambert"}, {"cook-torrance"}},
        Parameters{fp::width("m", 1), fp::albedo(), fp::f0(1)}));
    list.push_back(std::make_unique<KernelFamily<AveragedWardLobes>>(
        "lambert+ward-averaged",
        Lobes{{"lambert"}, {"ward", "azimuth=averaged"}},
        Parameters{fp::width("alpha_x", 1), fp::width("alpha_y", 1), fp::albedo(), ks()}));
    list.push_back(std::make_unique<KernelFamily<AnisotropicWardLobes>>(
        "lambert+ward-anisotropic",
        Lobes{{"lambert"}, {"ward"}},
        Parameters{fp::width("alpha_x", 1), fp::width("alpha_y", 1), fp::albedo(), ks()}));
}

}  // namespace gonio::proc
