// What the albedo of one incidence, R, G and B, costs for analytic models, beside std::pow of 4096
// numbers and the Riemann sum over degrees.

#include <benchmark/benchmark.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "proc/estimate/albedo.h"
#include "proc/estimate/seed_albedo.h"
#include "proc/models/spec.h"

namespace gonio::proc {
namespace {

std::unique_ptr<const AnalyticModel> model(const std::string& spec) {
    auto made = makeModel(spec);
    if (!made) throw std::runtime_error(made.error().message);
    return std::move(*made);
}

void pow(benchmark::State& state) {
    std::vector<double> c(4096), out(4096);
    for (std::size_t i = 0; i < c.size(); ++i) c[i] = 0.9 + 1e-5 * static_cast<double>(i);
    for (auto _ : state) {
        for (std::size_t i = 0; i < c.size(); ++i) out[i] = std::pow(c[i], 50.5);
        benchmark::DoNotOptimize(out.data());
    }
}

void directional(benchmark::State& state, const std::string& spec, double degrees) {
    const auto of = model(spec);
    const Direction wi = Direction::fromSpherical(Radians::fromDegrees(degrees), Radians(0.4));
    std::size_t evaluations = 0;
    for (auto _ : state) {
        const Albedo albedo = directionalAlbedo(*of, wi);
        evaluations = albedo.evaluations;
        benchmark::DoNotOptimize(albedo);
    }
    state.counters["evaluations"] = static_cast<double>(evaluations);
}

void riemann(benchmark::State& state, const std::string& spec) {
    const auto of = model(spec);
    const Direction wi = Direction::fromSpherical(40_deg, Radians(0.4));
    for (auto _ : state) benchmark::DoNotOptimize(riemannAlbedo(*of, wi));
}

void mean(benchmark::State& state, const std::string& spec) {
    const auto of = model(spec);
    for (auto _ : state) benchmark::DoNotOptimize(meanAlbedo(*of));
}

void registerAll() {
    benchmark::RegisterBenchmark("pow/double/4096", pow);
    for (const std::string& spec : {std::string("lambert,albedo=0.5"),
                                    std::string("ggx,alpha=0.01,f0=0.9/0.7/0.4"),
                                    std::string("ggx,alpha=0.3,f0=0.9/0.7/0.4"),
                                    std::string("lambert,albedo=0.3+ggx,alpha=0.1,f0=0.04")}) {
        for (const double degrees : {0.0, 40.0, 85.0}) {
            benchmark::RegisterBenchmark(
                ("directional/" + std::to_string(static_cast<int>(degrees)) + "/" + spec).c_str(),
                [=](benchmark::State& state) { directional(state, spec, degrees); });
        }
        benchmark::RegisterBenchmark(("riemann/40/" + spec).c_str(),
                                     [=](benchmark::State& state) { riemann(state, spec); });
        benchmark::RegisterBenchmark(("mean/" + spec).c_str(),
                                     [=](benchmark::State& state) { mean(state, spec); });
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
