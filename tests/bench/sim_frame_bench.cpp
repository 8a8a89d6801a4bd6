// What a frame of the simulated rig costs, with nothing wrong and with each imperfection: one
// exposure of 1024 x 1024 pixels, and the light of an LED on a new placement, which is worked out
// once for each. Imperfections are at their usual sizes.

#include <benchmark/benchmark.h>

#include <memory>

#include "proc/models/spec.h"
#include "sim/camera.h"

namespace gonio::sim {
namespace {

constexpr View kWindow{.x = 128, .y = 0, .size = {1024, 1024}};

Placement sample(const SampleErrors& errors, const Wedge& wedge) {
    static const std::shared_ptr<const Scatterer> surface =
        *proc::makeModel("lambert,albedo=0.2/0.1/0.05+ggx,alpha=0.1,f0=0.3");
    return {.role = Role::Sample, .surface = surface, .wedge = wedge, .errors = errors};
}

Image<std::uint16_t> frame(Camera& camera, std::uint64_t planStep) {
    const Settings settings{.led = 1, .levels = {0, 65535, 0}, .exposureUs = 320};
    return camera.expose(settings, {}, {.view = kWindow}, {.seed = 1, .planStep = planStep});
}

void exposures(benchmark::State& state, const RigErrors& rig, const SampleErrors& errors) {
    Camera camera("SIM-0001", {.rig = rig});
    camera.place(sample(errors, {}));
    std::uint64_t planStep = 0;
    benchmark::DoNotOptimize(frame(camera, planStep));
    for (auto _ : state) benchmark::DoNotOptimize(frame(camera, ++planStep));
}

void placements(benchmark::State& state, const RigErrors& rig, const Placement& placement) {
    Camera camera("SIM-0001", {.rig = rig});
    camera.place(placement);
    benchmark::DoNotOptimize(frame(camera, 0));
    for (auto _ : state) {
        camera.place(placement);
        benchmark::DoNotOptimize(frame(camera, 1));
    }
}

void repeated(benchmark::internal::Benchmark* bench) {
    bench->Unit(benchmark::kMillisecond)
        ->MeasureProcessCPUTime()
        ->Repetitions(5)
        ->ReportAggregatesOnly();
}

BENCHMARK_CAPTURE(exposures, plain, {}, {})->Apply(repeated);
BENCHMARK_CAPTURE(exposures, column_noise, {.columnNoise = 0.5}, {})->Apply(repeated);
BENCHMARK_CAPTURE(exposures, non_linearity, {.nonLinearity = 0.003}, {})->Apply(repeated);
BENCHMARK_CAPTURE(exposures, exposure_offset, {.exposureOffset = Nanoseconds(200)}, {})
    ->Apply(repeated);
BENCHMARK_CAPTURE(exposures, ambient, {}, {.ambient = 0.001})->Apply(repeated);
BENCHMARK_CAPTURE(exposures, soft, {}, {.softness = 0.05})->Apply(repeated);
BENCHMARK_CAPTURE(placements, plain, {}, sample({}, {}))->Apply(repeated);
BENCHMARK_CAPTURE(placements, glare, {.glare = 0.001}, sample({}, {}))->Apply(repeated);
BENCHMARK_CAPTURE(placements, crosstalk, {.crosstalk = 0.01}, sample({}, {}))->Apply(repeated);
BENCHMARK_CAPTURE(placements, source, {.sourceDiameter = 1_deg}, sample({}, {}))->Apply(repeated);
BENCHMARK_CAPTURE(placements, tilt, {}, sample({}, {.aboutY = 1_deg}))->Apply(repeated);
BENCHMARK_CAPTURE(placements, waviness, {}, sample({.waviness = 1_deg}, {}))->Apply(repeated);
BENCHMARK_CAPTURE(placements, translucent, {}, sample({.translucency = 0.1}, {}))->Apply(repeated);
BENCHMARK_CAPTURE(placements, soft, {}, sample({.softness = 0.05}, {}))->Apply(repeated);

}  // namespace
}  // namespace gonio::sim

BENCHMARK_MAIN();
