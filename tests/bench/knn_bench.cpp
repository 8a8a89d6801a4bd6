// What the ten nearest samples cost: by the tree, by a walk over all, and to build the tree, beside
// std::pow over 18 000 numbers in the same run. Samples and queries are those of the study
// (proc/table/neighbour_study.h). Medians of five: --benchmark_repetitions=5 is set here.

#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <vector>

#include "proc/table/neighbour_study.h"

namespace {

using namespace gonio;
using namespace gonio::proc;

constexpr NeighbourQuery kTen{.count = 10};

/// Built once: a million samples take seconds.
const ScatteredSet& setOf(std::size_t count, PairSymmetry symmetry) {
    static std::map<std::pair<std::size_t, PairSymmetry>, ScatteredSet> sets;
    const auto [place, made] = sets.try_emplace({count, symmetry}, symmetry);
    if (made) (void)place->second.add(rigLikeSamples(count, 1));
    return place->second;
}

template <class Nearest>
void ask(benchmark::State& state, const Nearest& nearest) {
    const std::vector<ScatteredSample> queries = rigLikeSamples(4096, 2);
    std::size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(nearest(queries[i++ % queries.size()].pair));
}

void byTree(benchmark::State& state, PairSymmetry symmetry) {
    const ScatteredSet& set = setOf(static_cast<std::size_t>(state.range(0)), symmetry);
    ask(state, [&](const LightView& at) { return set.nearest(at, kTen); });
    state.counters["tree_bytes"] = static_cast<double>(set.treeBytes());
    state.counters["sample_bytes"] = static_cast<double>(set.sampleBytes());
}

void byWalk(benchmark::State& state, PairSymmetry symmetry) {
    const ScatteredSet& set = setOf(static_cast<std::size_t>(state.range(0)), symmetry);
    ask(state, [&](const LightView& at) { return set.nearestByBruteForce(at, kTen); });
}

void build(benchmark::State& state, PairSymmetry symmetry) {
    const auto samples = rigLikeSamples(static_cast<std::size_t>(state.range(0)), 1);
    for (auto _ : state) {
        ScatteredSet set(symmetry);
        (void)set.add(samples);
        benchmark::DoNotOptimize(set);
    }
}

void powOf(benchmark::State& state) {
    std::vector<double> x(18'000, 0.7);
    for (auto _ : state) {
        for (double& v : x) benchmark::DoNotOptimize(std::pow(v, 12.3));
    }
}

void sizes(benchmark::internal::Benchmark* bench) {
    bench->RangeMultiplier(10)->Range(1'000, 1'000'000)->Unit(benchmark::kMicrosecond);
    bench->Repetitions(5)->ReportAggregatesOnly()->MinTime(0.05);
}

BENCHMARK(powOf)->Name("std::pow/18000")->Unit(benchmark::kMicrosecond)->Repetitions(5);
BENCHMARK_CAPTURE(byTree, plain, PairSymmetry::None)->Apply(sizes);
BENCHMARK_CAPTURE(byTree, isotropic, PairSymmetry::Isotropic)->Apply(sizes);
BENCHMARK_CAPTURE(byWalk, plain, PairSymmetry::None)->Apply(sizes);
BENCHMARK_CAPTURE(byWalk, isotropic, PairSymmetry::Isotropic)->Apply(sizes);
BENCHMARK_CAPTURE(build, plain, PairSymmetry::None)->Apply(sizes);
BENCHMARK_CAPTURE(build, isotropic, PairSymmetry::Isotropic)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
