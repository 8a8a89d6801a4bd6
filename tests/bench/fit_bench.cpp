// What a fit costs, beside std::pow over as many numbers and memcpy of as many bytes in the same
// run. Medians of five: --benchmark_repetitions=5 is set here.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstring>

#include "proc/fit/model_fit.h"
#include "proc/models/spec.h"
#include "tests/fit/simulated.h"

namespace {

using namespace gonio;
using namespace gonio::proc;

constexpr const char* kPlastic = "lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.1,f0=0.05";
constexpr const char* kTwoLobes =
    "lambert,albedo=0.1+ggx,alpha=0.05,f0=0.03/0.04/0.05+ggx,alpha=0.4,f0=0.1";

/// A sample of all cells at four incidences, with noise.
BrdfData wholeCapture(const char* spec) {
    const auto surface = makeModel(spec);
    SampleSet set;
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (const Radians incidence : {0_deg, 20_deg, 40_deg, 60_deg}) {
        LedTable led;
        led.incidence = incidence;
        for (const Band band : kBands) {
            CellSamples cells = CellSamples::missing(CellGrid::count());
            for (std::size_t i = 0; i < cells.size(); ++i) {
                const double f = (*surface)
                                     ->answer({Direction::fromSpherical(incidence, Radians(0)),
                                               CellGrid::centre(i)})
                                     .f[band];
                cells.uRandom[i] = std::hypot(0.01 * f, 2e-4);
                cells.uSystematic[i] = 0.01 * f;
                cells.f[i] = f + cells.uRandom[i] * normal(random);
                cells.flags[i] = Flags{Flag::Measured};
            }
            led.bands[index(band)] = std::move(cells);
        }
        set.leds.push_back(std::move(led));
    }
    return fitDataOf(set);
}

void fitTo(benchmark::State& state, const BrdfData& data, const char* family) {
    ModelFitOptions options;
    options.heldOutRows = 0;
    const Family& chosen = **familyNamed(family);
    for (auto _ : state) benchmark::DoNotOptimize(fitModel(chosen, data, options));
    state.counters["values"] = static_cast<double>(data.valueCount());
}

void fitSixThousand(benchmark::State& state, const char* spec, const char* family) {
    const auto surface = makeModel(spec);
    fitTo(state, test::noisy(test::simulated(**surface, 1500), 1), family);
}

void fitCapture(benchmark::State& state, const char* spec, const char* family) {
    fitTo(state, wholeCapture(spec), family);
}

void powOf(benchmark::State& state) {
    std::vector<double> x(18'000, 0.7);
    for (auto _ : state) {
        for (double& v : x) benchmark::DoNotOptimize(std::pow(v, 12.3));
    }
}

void copyOf(benchmark::State& state) {
    const std::vector<double> from(1'000'000, 1);
    std::vector<double> to(from.size());
    for (auto _ : state) {
        std::memcpy(to.data(), from.data(), from.size() * sizeof(double));
        benchmark::ClobberMemory();
    }
}

void everything(benchmark::internal::Benchmark* bench) {
    bench->Unit(benchmark::kMillisecond)->Repetitions(5)->ReportAggregatesOnly();
}

BENCHMARK_CAPTURE(fitSixThousand, plastic, kPlastic, "lambert+ggx")->Apply(everything);
BENCHMARK_CAPTURE(fitSixThousand, two_lobes, kTwoLobes, "lambert+ggx+ggx")->Apply(everything);
BENCHMARK_CAPTURE(fitCapture, plastic, kPlastic, "lambert+ggx")->Apply(everything);
BENCHMARK_CAPTURE(fitCapture, two_lobes, kTwoLobes, "lambert+ggx+ggx")->Apply(everything);
BENCHMARK(powOf)->Name("std::pow/18000")->Apply(everything);
BENCHMARK(copyOf)->Name("memcpy/8MB")->Apply(everything);

}  // namespace

BENCHMARK_MAIN();
