// What an evaluation of each model costs, RGB, one pair at a time and in arrays of 4096, in float
// and double, at each effort, beside std::pow of the same arrays.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <map>
#include <random>

#include "proc/models/spec.h"
#include "tests/support/random_directions.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kPairs = 4096;

struct Pairs {
    std::vector<LightView> views;
    std::array<std::vector<double>, 6> exact;
    std::array<std::vector<float>, 6> narrow;
};

const Pairs& pairs() {
    static const Pairs made = [] {
        Pairs p;
        std::mt19937_64 random(1);
        for (std::size_t i = 0; i < kPairs; ++i) {
            const LightView view{test::randomDirection(random), test::randomDirection(random)};
            p.views.push_back(view);
            for (std::size_t k = 0; k < 3; ++k) {
                const auto axis = static_cast<Eigen::Index>(k);
                p.exact[k].push_back(view.in.vector()[axis]);
                p.exact[k + 3].push_back(view.out.vector()[axis]);
                p.narrow[k].push_back(static_cast<float>(view.in.vector()[axis]));
                p.narrow[k + 3].push_back(static_cast<float>(view.out.vector()[axis]));
            }
        }
        return p;
    }();
    return made;
}

template <class T>
const std::array<std::vector<T>, 6>& components() {
    if constexpr (std::is_same_v<T, float>) {
        return pairs().narrow;
    } else {
        return pairs().exact;
    }
}

void perPair(benchmark::State& state) {
    state.counters["per_pair"] = benchmark::Counter(
        static_cast<double>(kPairs),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

std::unique_ptr<const AnalyticModel> model(const std::string& spec, EvalPath path) {
    auto made = makeModel(spec, path);
    if (!made) throw std::runtime_error(made.error().message);
    return std::move(*made);
}

void oneByOne(benchmark::State& state, const std::string& spec, EvalPath path) {
    const auto m = model(spec, path);
    for (auto _ : state) {
        for (const LightView& view : pairs().views) {
            benchmark::DoNotOptimize(m->answer(view).f);
        }
    }
    perPair(state);
}

template <class T>
void inArrays(benchmark::State& state, const std::string& spec, Effort effort) {
    const auto m = model(spec, {effort, Precision::Double});
    const auto& in = components<T>();
    std::array<std::vector<T>, 3> out;
    for (auto& band : out) band.resize(kPairs);
    for (auto _ : state) {
        m->evaluate(PairArrays<T>{in[0], in[1], in[2], in[3], in[4], in[5]},
                    BandArrays<T>{out[0], out[1], out[2]});
        benchmark::DoNotOptimize(out[1].data());
        benchmark::ClobberMemory();
    }
    perPair(state);
}

template <class T>
void pow(benchmark::State& state) {
    const auto& in = components<T>();
    std::vector<T> out(kPairs);
    for (auto _ : state) {
        for (std::size_t i = 0; i < kPairs; ++i) out[i] = std::pow(in[2][i], T(50.5));
        benchmark::DoNotOptimize(out.data());
        benchmark::ClobberMemory();
    }
    perPair(state);
}

/// What each model costs in docs/models.md.
const std::vector<std::string> kSpecs{"lambert,albedo=0.5",
                                      "oren-nayar,albedo=0.5,sigma=0.3",
                                      "fujii-oren-nayar,albedo=0.5,r=0.7",
                                      "disney-diffuse,albedo=0.5,roughness=0.5",
                                      "frostbite-diffuse,albedo=0.5,roughness=0.5",
                                      "cod-wwii-diffuse,albedo=0.5,alpha=0.3",
                                      "phong,kd=0.2,ks=0.5,n=50",
                                      "lafortune-phong,kd=0.2,ks=0.5,n=50",
                                      "lafortune,cxy=-0.9,cz=1,n=50",
                                      "blinn-phong,kd=0.2,ks=0.5,n=50",
                                      "ward,alpha=0.2,ks=0.5",
                                      "cook-torrance,m=0.2,f0=0.5",
                                      "low,roughness=0.2,eta=1.5",
                                      "ggx,alpha=0.2,f0=0.9/0.7/0.4",
                                      "ggx,alpha_x=0.2,alpha_y=0.4,f0=0.9/0.7/0.4",
                                      "ggx,alpha=0.2,eta=0.2/0.4/1.2,k=3.5/2.4/2,fresnel=exact",
                                      "ggx,alpha=0.2,f0=0.9,multiscatter=kulla-conty",
                                      "beckmann,alpha=0.2,f0=0.9",
                                      "walter,alpha=0.2,eta=1.5",
                                      "clearcoat,strength=1,gloss=0.5",
                                      "disney,base=0.5,clearcoat=0.5",
                                      "metallic-roughness,base=0.5,metallic=0.5,roughness=0.5",
                                      "lambert,albedo=0.3+ggx,alpha=0.2,f0=0.04"};

void registerAll() {
    benchmark::RegisterBenchmark("pow/float", pow<float>);
    benchmark::RegisterBenchmark("pow/double", pow<double>);
    for (const std::string& spec : kSpecs) {
        benchmark::RegisterBenchmark(("one/double/" + spec).c_str(), [=](benchmark::State& state) {
            oneByOne(state, spec, {Effort::Reference, Precision::Double});
        });
        for (Effort effort : {Effort::Draft, Effort::Standard, Effort::Reference}) {
            const std::string at = std::string(name(effort)) + "/" + spec;
            benchmark::RegisterBenchmark(
                ("array/float/" + at).c_str(),
                [=](benchmark::State& state) { inArrays<float>(state, spec, effort); });
            benchmark::RegisterBenchmark(
                ("array/double/" + at).c_str(),
                [=](benchmark::State& state) { inArrays<double>(state, spec, effort); });
        }
    }
}

}  // namespace
}  // namespace gonio::proc

int main(int argc, char** argv) {
    gonio::proc::registerAll();
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
