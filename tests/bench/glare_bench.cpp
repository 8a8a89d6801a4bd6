// What taking glare off a picture of 1024 x 1024 pixels costs, beside a copy of its bytes, and with
// the binning that it adds to.

#include <benchmark/benchmark.h>

#include <algorithm>

#include "proc/optics/glare.h"
#include "tests/optics/lenses.h"

namespace gonio::proc {
namespace {

constexpr Radians kField = 75_deg;
const GlareSpread kSpread{.everywhere = 0.0005, .halo = 0.0005, .radius = 64, .exponent = 1};

MergedState picture() {
    const Window window = test::middleWindow();
    MergedState state{.radiance = Image<float>(window.sent(), 1),
                      .variance = Image<float>(window.sent(), 1),
                      .used = {},
                      .saturated = {},
                      .window = window};
    state.radiance.at(600, 500) = 1e6F;
    return state;
}

void copy(benchmark::State& state) {
    const MergedState merged = picture();
    Image<float> out = merged.radiance;
    for (auto _ : state) {
        std::copy(
            merged.radiance.pixels().begin(), merged.radiance.pixels().end(), out.pixels().begin());
        benchmark::DoNotOptimize(out);
    }
}

void clean(benchmark::State& state) {
    const MergedState merged = picture();
    const GlareFilter filter(kSpread, test::crookedLens(), merged.window, kField);
    for (auto _ : state) benchmark::DoNotOptimize(filter.clean(merged.radiance));
}

void prepare(benchmark::State& state) {
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            GlareFilter(kSpread, test::crookedLens(), test::middleWindow(), kField));
    }
}

void bin(benchmark::State& state, const GlareSpread& spread) {
    const MergedState merged = picture();
    const Binning binning(test::crookedLens(), merged.window, kField);
    const GlareFilter filter(spread, test::crookedLens(), merged.window, kField);
    for (auto _ : state) benchmark::DoNotOptimize(filter.bin(merged, binning));
}

BENCHMARK(copy)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(clean)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(prepare)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(bin, glare, kSpread)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(bin, none, GlareSpread{})->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace gonio::proc

BENCHMARK_MAIN();
