#include "proc/fit/family_kernel.h"
#include "proc/models/beckmann.h"
#include "proc/models/disney_diffuse.h"
#include "proc/models/ggx.h"
#include "proc/models/gtr.h"
#include "proc/models/lafortune.h"
#include "proc/models/lambert.h"
#include "proc/models/oren_nayar.h"

namespace gonio::proc {
namespace {

namespace fp = family_parameters;

/// Schlick's Fresnel, height-correlated masking: the defaults of a spec.
template <template <class> class Kernel, class P>
Kernel<P> lobe(const P& alpha, const Bands<P>& f0) {
    return {.alpha = Alpha<P>::isotropic(alpha),
            .fresnel = {.form = FresnelForm::Schlick, .f0 = f0, .eta = {}, .k = {}}};
}

struct MetalLobes {
    static constexpr int kShared = 1;
    static constexpr int kPerBand = 1;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return lobe<Ggx>(shared[0], perBand[0]);
    }
};

template <template <class> class Kernel>
struct GlossyLobes {
    static constexpr int kShared = 1;
    static constexpr int kPerBand = 2;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return BothKernels{Lambert<P>{perBand[0]}, lobe<Kernel>(shared[0], perBand[1])};
    }
};

/// Tails as long as the data want them.
struct TailedLobes {
    static constexpr int kShared = 2;
    static constexpr int kPerBand = 2;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return BothKernels{Lambert<P>{perBand[0]},
                           Gtr<P>{.alpha = shared[0],
                                  .gamma = shared[1],
                                  .peak = gtrPeak(shared[0], shared[1]),
                                  .fresnel = lobe<Ggx>(shared[0], perBand[1]).fresnel}};
    }
};

/// A cosine lobe back towards the light beside the mirror lobe.
struct RetroLobes {
    static constexpr int kShared = 2;
    static constexpr int kPerBand = 3;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return BothKernels{Lambert<P>{perBand[0]},
                           BothKernels{lobe<Ggx>(shared[0], perBand[1]),
                                       Lafortune<P>{perBand[2], P(1), P(1), shared[1]}}};
    }
};

struct TwoLobes {
    static constexpr int kShared = 2;
    static constexpr int kPerBand = 3;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return BothKernels{
            Lambert<P>{perBand[0]},
            BothKernels{lobe<Ggx>(shared[0], perBand[1]), lobe<Ggx>(shared[1], perBand[2])}};
    }
};

/// A rough diffuse kernel below a GGX lobe.
template <template <class> class Diffuse>
struct RoughGlossyLobes {
    static constexpr int kShared = 2;
    static constexpr int kPerBand = 2;
    template <class P>
    static auto kernel(const P* shared, const Bands<P>* perBand) {
        return BothKernels{Diffuse<P>{perBand[0], shared[0]}, lobe<Ggx>(shared[1], perBand[1])};
    }
};

template <class Lobes>
void add(FamilyList& list,
         std::string name,
         std::vector<FamilyLobe> lobes,
         std::vector<FamilyParameter> parameters) {
    list.push_back(std::make_unique<KernelFamily<Lobes>>(
        std::move(name), std::move(lobes), std::move(parameters)));
}

}  // namespace

void addMicrofacetFamilies(FamilyList& list) {
    add<MetalLobes>(list, "ggx", {{"ggx"}}, {fp::width("alpha"), fp::f0()});
    add<GlossyLobes<Ggx>>(list,
                          "lambert+ggx",
                          {{"lambert"}, {"ggx"}},
                          {fp::width("alpha", 1), fp::albedo(), fp::f0(1)});
    add<GlossyLobes<Beckmann>>(list,
                               "lambert+beckmann",
                               {{"lambert"}, {"beckmann"}},
                               {fp::width("alpha", 1), fp::albedo(), fp::f0(1)});
    add<RoughGlossyLobes<DisneyDiffuse>>(
        list,
        "disney-diffuse+ggx",
        {{"disney-diffuse"}, {"ggx"}},
        {{.name = "roughness", .unit = "1", .starts = {0.1, 0.5, 0.9}},
         fp::width("alpha", 1),
         fp::albedo(),
         fp::f0(1)});
    add<RoughGlossyLobes<OrenNayar>>(
        list,
        "oren-nayar+ggx",
        {{"oren-nayar"}, {"ggx"}},
        {{.name = "sigma", .unit = "rad", .upper = kPi / 2, .starts = {0.15, 0.4, 0.9}},
         fp::width("alpha", 1),
         fp::albedo(),
         fp::f0(1)});
    add<TwoLobes>(
        list,
        "lambert+ggx+ggx",
        {{"lambert"}, {"ggx"}, {"ggx"}},
        {fp::width("alpha", 1), fp::secondWidth("alpha", 2), fp::albedo(), fp::f0(1), fp::f0(2)});
    add<TailedLobes>(list,
                     "lambert+gtr",
                     {{"lambert"}, {"gtr"}},
                     {fp::width("alpha", 1),
                      {.name = "gamma",
                       .lobe = 1,
                       .unit = "1",
                       .lower = 0.6,
                       .upper = 10,
                       .scale = ParameterScale::Log,
                       .starts = {1.2, 2, 4}},
                      fp::albedo(),
                      fp::f0(1)});
    FamilyParameter ks = fp::ks();
    ks.lobe = 2;
    add<RetroLobes>(list,
                    "lambert+ggx+retro",
                    {{"lambert"}, {"ggx"}, {"lafortune", "cxy=1,cz=1"}},
                    {fp::width("alpha", 1),
                     {.name = "n",
                      .lobe = 2,
                      .unit = "1",
                      .lower = 1,
                      .upper = 8e4,
                      .scale = ParameterScale::Log,
                      .starts = {3, 20, 200, 2000}},
                     fp::albedo(),
                     fp::f0(1),
                     ks});
}

}  // namespace gonio::proc
