// What a look-up costs, R, G and B, at cosine-distributed pairs in random order: baked tables one
// pair at a time and in arrays, a draw with its density, the MERL layout, beside std::pow of as
// many numbers and the model that was baked.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "proc/estimate/bake.h"
#include "proc/estimate/lobe_draw.h"
#include "proc/estimate/lookup_pairs.h"
#include "proc/estimate/merl_layout.h"
#include "proc/models/spec.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kPairs = 16384;
const std::string kTruth =
    "lambert,albedo=0.3/0.2/0.1+ggx,f0=0.04,alpha=0.16+ggx,f0=0.03,alpha=0.32";
const std::string kCarrier = "lambert,albedo=0.3/0.2/0.1+ggx,f0=0.055,alpha=0.208";

std::unique_ptr<const AnalyticModel> model(const std::string& spec, EvalPath path = {}) {
    auto made = makeModel(spec, path);
    if (!made) throw std::runtime_error(made.error().message);
    return std::move(*made);
}

const std::vector<LightView>& views() {
    static const auto made = cosinePairs({kPairs, 1});
    return made;
}

BakedTable table(TableStorage storage, bool carried) {
    auto carrier = carried ? model(kCarrier, {Effort::Standard, Precision::Float}) : nullptr;
    auto made =
        bakeTable(*model(kTruth), std::move(carrier), {.resolution = {}, .storage = storage});
    if (!made) throw std::runtime_error(made.error().message);
    return std::move(*made);
}

void perPair(benchmark::State& state) {
    state.counters["per_pair"] = benchmark::Counter(
        static_cast<double>(kPairs),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class Lookup>
void oneByOne(benchmark::State& state, const Lookup& lookup) {
    for (auto _ : state) {
        for (const LightView& view : views()) benchmark::DoNotOptimize(lookup(view));
    }
    perPair(state);
}

void pow(benchmark::State& state) {
    oneByOne(state, [](const LightView& view) { return std::pow(view.in.z(), 50.5); });
}

void inArrays(benchmark::State& state, const BakedTable& of) {
    std::array<std::vector<float>, 9> a;
    for (auto& values : a) values.resize(kPairs);
    for (std::size_t i = 0; i < kPairs; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<Eigen::Index>(k);
            a[k][i] = static_cast<float>(views()[i].in.vector()[axis]);
            a[k + 3][i] = static_cast<float>(views()[i].out.vector()[axis]);
        }
    }
    for (auto _ : state) {
        of.evaluate(PairArrays<float>{a[0], a[1], a[2], a[3], a[4], a[5]},
                    BandArrays<float>{a[6], a[7], a[8]});
        benchmark::DoNotOptimize(a[6].data());
    }
    perPair(state);
}

void draws(benchmark::State& state, const BakedTable& of) {
    const LobeDraw draw(of, lobesAbout(0.1));
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit;
    std::vector<Uniforms> numbers(kPairs);
    for (Uniforms& one : numbers) one = {unit(random), unit(random), unit(random)};
    for (auto _ : state) {
        for (std::size_t i = 0; i < kPairs; ++i) {
            benchmark::DoNotOptimize(draw.draw(views()[i].in, numbers[i]));
        }
    }
    perPair(state);
}

void registerAll() {
    benchmark::RegisterBenchmark("pow/double", pow);
    benchmark::RegisterBenchmark("truth/one", [](benchmark::State& state) {
        const auto truth = model(kTruth);
        oneByOne(state, [&](const LightView& view) { return truth->answer(view).f; });
    });
    for (const TableStorage storage : {TableStorage::Float, TableStorage::Half}) {
        for (const bool carried : {true, false}) {
            const std::string kind = std::string(storage == TableStorage::Half ? "half" : "float") +
                                     (carried ? "/carrier" : "/alone");
            benchmark::RegisterBenchmark(("one/" + kind).c_str(), [=](benchmark::State& state) {
                const BakedTable of = table(storage, carried);
                oneByOne(state, [&](const LightView& view) { return of.evaluate(view); });
            });
            benchmark::RegisterBenchmark(("array/" + kind).c_str(), [=](benchmark::State& state) {
                inArrays(state, table(storage, carried));
            });
        }
    }
    benchmark::RegisterBenchmark(
        "draw", [](benchmark::State& state) { draws(state, table(TableStorage::Half, true)); });
    for (const MerlLookup how : {MerlLookup::Nearest, MerlLookup::Trilinear}) {
        const bool nearest = how == MerlLookup::Nearest;
        benchmark::RegisterBenchmark(
            nearest ? "merl/nearest" : "merl/trilinear", [=](benchmark::State& state) {
                const MerlLayout of(*model(kTruth));
                oneByOne(state, [&](const LightView& view) { return of.evaluate(view, how); });
            });
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
