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

/// One Fresnel reflectance for all bands and a strength for each, as fits of colour-blind lobes
/// have.
struct ScaledCookTorranceLobes {
    static constexpr int kShared = 2;
    static constexpr int kPerBand = 2;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return BothKernels{Lambert<P>{perBand[0]},
                           CookTorrance<P>{shared[0], Bands<P>::all(shared[1]), perBand[1]}};
    }
};

struct LowLobes {
    static constexpr int kShared = 2;
    static constexpr int kPerBand = 2;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return BothKernels{Lambert<P>{perBand[0]},
                           Low<P>{shared[0], Bands<P>::all(shared[1]), perBand[1]}};
    }
};

}  // namespace

void addSlopeFamilies(FamilyList& list) {
    using Lobes = std::vector<FamilyLobe>;
    using Parameters = std::vector<FamilyParameter>;
    list.push_back(std::make_unique<KernelFamily<WardLobes>>(
        "lambert+ward",
        Lobes{{"lambert"}, {"ward"}},
        Parameters{fp::width("alpha", 1), fp::albedo(), fp::ks()}));
    list.push_back(std::make_unique<KernelFamily<CookTorranceLobes>>(
        "lambert+cook-torrance",
        Lobes{{"lambert"}, {"cook-torrance"}},
        Parameters{fp::width("m", 1), fp::albedo(), fp::f0(1)}));
    const FamilyParameter sharedF0{
        .name = "f0", .lobe = 1, .unit = "1", .starts = {0.02, 0.1, 0.4}};
    list.push_back(std::make_unique<KernelFamily<ScaledCookTorranceLobes>>(
        "lambert+cook-torrance-scaled",
        Lobes{{"lambert"}, {"cook-torrance"}},
        Parameters{fp::width("m", 1), sharedF0, fp::albedo(), fp::ks()}));
    FamilyParameter roughness = fp::width("roughness", 1);
    roughness.upper = 3;
    const FamilyParameter eta{.name = "eta",
                              .lobe = 1,
                              .unit = "1",
                              .lower = 1,
                              .upper = 20,
                              .scale = ParameterScale::Log,
                              .starts = {1.1, 1.6, 4, 10}};
    list.push_back(std::make_unique<KernelFamily<LowLobes>>(
        "lambert+low",
        Lobes{{"lambert"}, {"low"}},
        Parameters{roughness, eta, fp::albedo(), fp::ks()}));
    list.push_back(std::make_unique<KernelFamily<AveragedWardLobes>>(
        "lambert+ward-averaged",
        Lobes{{"lambert"}, {"ward", "azimuth=averaged"}},
        Parameters{
            fp::width("alpha_x", 1), fp::secondWidth("alpha_y", 1), fp::albedo(), fp::ks()}));
    list.push_back(std::make_unique<KernelFamily<AnisotropicWardLobes>>(
        "lambert+ward-anisotropic",
        Lobes{{"lambert"}, {"ward"}},
        Parameters{fp::width("alpha_x", 1), fp::width("alpha_y", 1), fp::albedo(), fp::ks()}));
}

}  // namespace gonio::proc
