// From captures to a calibrated sample: the frames of 12 states (4 LEDs x R, G, B), as a rig with
// the usual errors gives them, added up, merged, freed of glare, binned, calibrated and judged but
// for ambient light. The rig is
// simulated before the clock starts, so that it does not share the cores; the yardstick is a copy
// of the frames' pixels.

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <cstring>

#include "daemon/gathering.h"
#include "daemon/sample_quality.h"
#include "tests/daemon/lab.h"

namespace gonio::daemon {
namespace {

/// A captured sample, and all that it is worked out with.
class Capture {
public:
    Capture() : lab_("typical", "random", 7, 4) {
        lab_.calibrateMirror();
        lab_.calibrateBlack();
        lab_.calibrateWhite();
        frames_ = lab_.frames("ggx,alpha=0.1,f0=0.5", {.frames = 1});
        if (!lab_.lens() || !lab_.lens()->glare || frames_.brackets.empty()) std::abort();
        const Window& window = frames_.brackets.front().frames.front().window;
        const proc::LensMap& lens = lab_.lens()->fit.map;
        binning_.emplace(lens, window, kField);
        glare_.emplace(*lab_.lens()->glare, lens, window, kField);
    }

    /// All states, merged and binned.
    [[nodiscard]] Captured processed() const {
        const Processing processing{.darks = frames_.darks,
                                    .binning = *binning_,
                                    .glare = *glare_,
                                    .corrections = {},
                                    .profile = lab_.profile(),
                                    .clock = clock_};
        Captured captured;
        captured.signals.resize(lab_.ledAngles().size());
        proc::MergeAccumulator sums = processing.accumulator();
        for (const test::Lab::Bracket& bracket : frames_.brackets) {
            sums.restart(bracket.state.band);
            std::vector<proc::RawExposure> exposures;
            for (const Frame& frame : bracket.frames) {
                note(frame, bracket.state.band, exposures);
                if (!sums.add(frame)) std::abort();
            }
            auto done = processing(bracket.state, sums, exposures);
            if (!done) std::abort();
            const auto led = static_cast<std::size_t>(bracket.state.led);
            captured.signals[led][index(bracket.state.band)] = std::move(done->signal);
        }
        return captured;
    }

    /// The sample with its verdicts.
    [[nodiscard]] proc::SampleSet calibrated(const Captured& captured) const {
        const RigReferences references = lab_.references(test::Lab::Lower::Black);
        proc::SampleSet sample =
            calibrateSample(captured.signals, lab_.ledAngles(), references, {.name = "x"});
        judgeCapture(sample, captured, references);
        judgeTable(sample, lab_.profile().quality.sample);
        return sample;
    }

    [[nodiscard]] std::vector<std::uint16_t> pixels() const {
        std::vector<std::uint16_t> all;
        for (const test::Lab::Bracket& bracket : frames_.brackets) {
            for (const Frame& frame : bracket.frames) {
                const auto of = frame.pixels.pixels();
                all.insert(all.end(), of.begin(), of.end());
            }
        }
        return all;
    }

private:
    test::Lab lab_;
    test::Lab::Frames frames_;
    driver::SteadyClock clock_;
    std::optional<proc::Binning> binning_;
    std::optional<proc::GlareFilter> glare_;
};

const Capture& theCapture() {
    static const Capture capture;
    return capture;
}

void states(benchmark::State& state) {
    const Capture& capture = theCapture();
    for (auto _ : state) benchmark::DoNotOptimize(capture.processed());
}

void calibration(benchmark::State& state) {
    const Capture& capture = theCapture();
    const Captured captured = capture.processed();
    for (auto _ : state) benchmark::DoNotOptimize(capture.calibrated(captured));
}

void captureToSample(benchmark::State& state) {
    const Capture& capture = theCapture();
    for (auto _ : state) benchmark::DoNotOptimize(capture.calibrated(capture.processed()));
}

void copied(benchmark::State& state) {
    const std::vector<std::uint16_t> from = theCapture().pixels();
    std::vector<std::uint16_t> to(from.size());
    for (auto _ : state) {
        std::memcpy(to.data(), from.data(), from.size() * sizeof(from[0]));
        benchmark::ClobberMemory();
    }
}

void repeated(benchmark::internal::Benchmark* bench) {
    bench->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime()->Repetitions(5);
}
BENCHMARK(captureToSample)->Apply(repeated);
BENCHMARK(states)->Apply(repeated);
BENCHMARK(calibration)->Apply(repeated);
BENCHMARK(copied)->Apply(repeated);

}  // namespace
}  // namespace gonio::daemon

BENCHMARK_MAIN();
