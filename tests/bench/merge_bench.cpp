// What merging costs and how good it is. First, on stdout, bias and noise of this merge and of
// other published ones over a scene of 1e6 : 1, in the terms of docs/tradeoff.md; then the time of
// a frame of 1024 x 1024, 12 bit packed: unpacking, mask and sums, and its share of the weighing of
// a bracket of seven, against a copy of as many bytes.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>

#include "driver/protocol/pixels.h"
#include "proc/core/median.h"
#include "proc/radiance/merge.h"
#include "proc/radiance/poisson_check.h"
#include "tests/bench/merge_baselines.h"
#include "tests/radiance/frames.h"
#ifdef GONIO_HAS_OPENCV_PHOTO
#include "tests/bench/opencv_mergers.h"
#endif

namespace gonio {
namespace {

using namespace proc;
using test::Shot;

constexpr int kFrames = 7;
constexpr int kLevels = 25;
constexpr Size kLevelSize{400, 250};  // 100,000 pixels
constexpr Size kSize{1024, 1024};

/// Per level: relative bias, and RMS over the bound.
struct Accuracy {
    std::vector<double> bias, rms;
};

/// What each method made of one level: relative to the truth.
using Results = std::map<std::string, std::vector<double>>;

Results baselineResults(const std::vector<Frame>& bracket, double light) {
    const SensorNoise noise;
    Results results;
    std::vector<bench::Sample> samples;
    for (std::size_t i = 0; i < kLevelSize.pixels(); ++i) {
        samples.clear();
        for (const Frame& frame : bracket) {
            const double dn = frame.pixels.pixels()[i];
            if (dn >= noise.saturationDn()) continue;
            const double seconds = frame.exposure.seconds();
            const double dark = noise.darkElectronsPerSecond * seconds / noise.electronsPerDn;
            samples.push_back({.dn = dn - test::kBlackDn - dark, .seconds = seconds});
        }
        for (const bench::Baseline& baseline : bench::baselines()) {
            const double rate = baseline.merge(samples, noise.fullScaleDn - test::kBlackDn);
            results[baseline.name].push_back(rate * noise.electronsPerDn / light);
        }
    }
    return results;
}

void record(const std::vector<double>& relative, double light, Accuracy& to) {
    double bias = 0, squares = 0;
    for (const double x : relative) {
        bias += (x - 1) / static_cast<double>(relative.size());
        squares += (x - 1) * (x - 1) / static_cast<double>(relative.size());
    }
    to.bias.push_back(bias);
    to.rms.push_back(std::sqrt(squares) * light /
                     std::sqrt(test::cramerRao(test::wideLadder(), light)));
}

std::vector<double> relative(std::span<const float> values, double truth) {
    std::vector<double> list;
    for (const float v : values) list.push_back(static_cast<double>(v) / truth);
    return list;
}

/// The factor common to all levels that a result without a unit is multiplied with: 1 over the
/// median of the levels' means.
double commonFactor(const std::vector<std::vector<double>>& levels) {
    std::vector<double> means;
    for (const std::vector<double>& level : levels) {
        double mean = 0;
        for (const double x : level) mean += x / static_cast<double>(level.size());
        means.push_back(mean);
    }
    return 1 / median(means);
}

void printRow(const std::string& name, Accuracy accuracy) {
    double worstBias = 0, worstRms = 0;
    for (const double b : accuracy.bias)
        if (std::abs(b) > std::abs(worstBias)) worstBias = b;
    for (const double r : accuracy.rms) worstRms = std::max(worstRms, r);
    std::printf("| %s | %+.3f | %.3f | %.3f |\n",
                name.c_str(),
                100 * worstBias,
                median(accuracy.rms),
                worstRms);
}

void printAccuracy() {
    const std::vector<Shot> shots = test::wideLadder();
    const DarkLibrary darks = test::perfectDarks(shots, kLevelSize);
    std::map<std::string, Accuracy> all;
    std::map<std::string, std::vector<std::vector<double>>> unitless;
    std::vector<double> lights;
    double poisson = 0;
    std::mt19937_64 random(71);
    for (int level = 0; level < kLevels; ++level) {
        const double light = 420 * std::pow(10, level / 4.0);
        lights.push_back(light);
        std::vector<Frame> bracket;
        MergeAccumulator accumulator(Band::G, darks, {});
        for (Shot shot : shots) {
            shot.electronsPerSecond = light;
            bracket.push_back(test::take(shot, kLevelSize, random));
            (void)accumulator.add(bracket.back());
        }
        const auto state = mergeSums(accumulator.sums());
        if (!state) return;
        record(relative(state->radiance.pixels(), light), light, all["gonio"]);
        const PoissonCheck check = poissonCheck(accumulator.sums(), *state);
        poisson = std::max(poisson, std::abs(check.difference / check.electrons));
        for (const auto& [name, values] : baselineResults(bracket, light))
            record(values, light, all[name]);
#ifdef GONIO_HAS_OPENCV_PHOTO
        for (const bench::OpenCvResult& result : bench::openCvMerged(bracket))
            unitless[result.name].push_back(relative(result.light, light));
#endif
    }
    for (auto& [name, levels] : unitless) {
        const double factor = commonFactor(levels);
        for (std::size_t i = 0; i < levels.size(); ++i) {
            for (double& x : levels[i]) x *= factor;
            record(levels[i], lights[i], all[name]);
        }
    }
    std::printf(
        "%d levels 420 .. 4.2e8 e-/s, %zu pixels each, 7 frames of 20 us x 8^k, seed 71\n\n",
        kLevels,
        kLevelSize.pixels());
    std::printf("| merge | worst bias %% | RMS / bound, median | worst |\n|---|---|---|---|\n");
    for (const auto& [name, accuracy] : all) printRow(name, accuracy);
    std::printf("\nmerge against its Poisson sum: at most %.3f %%\n\n", 100 * poisson);
}

/// A frame of all values up to saturation.
Frame fullFrame(int exposure) {
    Frame frame = test::unexposed({.seconds = 20e-6 * std::pow(8, exposure)}, kSize);
    std::uint32_t value = 1;
    for (std::uint16_t& pixel : frame.pixels.pixels()) {
        value = value * 1664525U + 1013904223U;
        pixel = static_cast<std::uint16_t>(value >> 20U);
    }
    return frame;
}

/// Bytes that the steps of one frame read and write: packed pixels, the picture (written, read),
/// the tallies (cleared, read, written; read again for the result), the dark frame, a seventh of
/// the result.
constexpr double kBytesPerPixel = 1.5 + 2 + 2 + 4 + 4 + 4 + 4 + 4 + 10.0 / kFrames;
constexpr auto kTouched = static_cast<std::size_t>(kBytesPerPixel * 1024 * 1024);

/// CPU time of one core per frame: all threads' time counts.
void mergedFrame(benchmark::State& state, const Linearity& response) {
    std::vector<std::vector<std::uint8_t>> wire;
    std::vector<Frame> frames;
    for (int i = 0; i < kFrames; ++i) {
        frames.push_back(fullFrame(i));
        wire.push_back(driver::packPixels(frames.back().pixels, driver::PixelFormat::Mono12Packed));
    }
    const DarkLibrary darks = test::perfectDarks(test::wideLadder(), kSize);
    MergeAccumulator accumulator(Band::G, darks, {}, response);
    for (auto _ : state) {
        accumulator.restart(Band::G);
        for (std::size_t i = 0; i < frames.size(); ++i) {
            frames[i].pixels =
                driver::unpackPixels(wire[i], kSize, driver::PixelFormat::Mono12Packed);
            if (!accumulator.add(frames[i])) state.SkipWithError("refused");
        }
        auto merged = mergeSums(accumulator.sums());
        benchmark::DoNotOptimize(merged);
    }
    state.SetItemsProcessed(state.iterations() * kFrames);
}
BENCHMARK_CAPTURE(mergedFrame, proportional, Linearity{})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->Repetitions(5);
/// A response that was measured to bend by 0.3 %, of the usual degree.
BENCHMARK_CAPTURE(mergedFrame,
                  linearised,
                  Linearity{.blackDn = 64, .rangeDn = 4031, .coefficients = {0.012, -0.012, 1e-4}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->Repetitions(5);

/// The same frames added only: what has to keep up with the camera.
void addedFrame(benchmark::State& state) {
    const Frame frame = fullFrame(0);
    const auto wire = driver::packPixels(frame.pixels, driver::PixelFormat::Mono12Packed);
    const DarkLibrary darks = test::perfectDarks(test::wideLadder(), kSize);
    MergeAccumulator accumulator(Band::G, darks, {});
    Frame arriving = frame;
    for (auto _ : state) {
        accumulator.restart(Band::G);
        arriving.pixels = driver::unpackPixels(wire, kSize, driver::PixelFormat::Mono12Packed);
        if (!accumulator.add(arriving)) state.SkipWithError("refused");
    }
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(addedFrame)->Unit(benchmark::kMillisecond)->Repetitions(5);

/// The yardstick: a copy of as many bytes as a frame touches.
void copied(benchmark::State& state) {
    const std::vector<std::uint8_t> from(kTouched, 1);
    std::vector<std::uint8_t> to(kTouched);
    for (auto _ : state) {
        std::memcpy(to.data(), from.data(), from.size());
        benchmark::ClobberMemory();
    }
}
BENCHMARK(copied)->Unit(benchmark::kMillisecond)->Repetitions(5);

/// A stricter one: a copy that reads and writes as many bytes as a frame touches.
void copiedHalf(benchmark::State& state) {
    const std::vector<std::uint8_t> from(kTouched / 2, 1);
    std::vector<std::uint8_t> to(kTouched / 2);
    for (auto _ : state) {
        std::memcpy(to.data(), from.data(), from.size());
        benchmark::ClobberMemory();
    }
}
BENCHMARK(copiedHalf)->Unit(benchmark::kMillisecond)->Repetitions(5);

}  // namespace
}  // namespace gonio

int main(int argc, char** argv) {
    gonio::printAccuracy();
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
