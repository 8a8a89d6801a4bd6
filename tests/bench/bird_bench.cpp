// A BiRD file of 300 000 entries, all columns there are, beside a plain copy of its bytes.

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "proc/formats/bird.h"

namespace gonio::proc {
namespace {

BrdfRows manyRows() {
    BrdfRows rows;
    rows.channels = Channel::ofBands();
    for (const double incidence : {0.0, 20.0, 40.0, 60.0}) {
        for (int i = 0; i < 25'000; ++i) {
            const double at = i + 0.5;
            const double theta = std::acos(1 - at / 25'000) * 0.99;
            rows.pairs.push_back(
                {.in = Direction::fromSpherical(Radians::fromDegrees(incidence), Radians()),
                 .out = Direction::fromSpherical(Radians(theta), Radians(at * 2.399963))});
            for (int c = 0; c < 3; ++c) {
                const double f = 0.3 / (1 + at * 1e-4 + c + incidence);
                rows.f.push_back(f);
                rows.uRandom.push_back(0.003 * f);
                rows.uSystematic.push_back(0.011 * f);
                rows.flags.push_back(Flags{Flag::Measured});
            }
        }
    }
    return rows;
}

const std::string& manyText() {
    static const std::string text = writeBird(manyRows(), {})->bytes;
    return text;
}

void count(benchmark::State& state) {
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(manyText().size()));
}

void copy(benchmark::State& state) {
    for (auto _ : state) {
        std::string bytes = manyText();
        benchmark::DoNotOptimize(bytes.data());
    }
    count(state);
}
void write(benchmark::State& state) {
    const BrdfRows rows = manyRows();
    for (auto _ : state) benchmark::DoNotOptimize(writeBird(rows, {})->bytes.data());
    count(state);
}
void read(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(parseBird(manyText(), "bench"));
    count(state);
}

BENCHMARK(copy)->Unit(benchmark::kMillisecond);
BENCHMARK(write)->Unit(benchmark::kMillisecond);
BENCHMARK(read)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gonio::proc

BENCHMARK_MAIN();
