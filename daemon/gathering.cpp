#include "daemon/gathering.h"

#include <utility>

namespace gonio::daemon {
namespace {

/// The bracket's captures, in the order in which they were taken.
std::vector<proc::RawExposure> describeBracket(const std::vector<Frame>& frames, Band band) {
    std::vector<proc::RawExposure> list;
    for (const Frame& frame : frames) {
        if (list.empty() || list.back().captureId != frame.captureId) {
            list.push_back({.captureId = frame.captureId,
                            .granted = frame.exposure.granted,
                            .level = frame.levels[band],
                            .frames = 0,
                            .blackLevel = frame.blackLevel,
                            .celsius = frame.celsius});
        }
        ++list.back().frames;
    }
    return list;
}

}  // namespace

Result<Processed> Processing::operator()(State state, const std::vector<Frame>& frames) const {
    const Stopwatch processing(clock);
    proc::MergeAccumulator accumulator(state.band, darks, noise);
    for (const Frame& frame : frames)
        if (Result<void> added = accumulator.add(frame); !added) return added.error();
    Result<proc::MergedState> merged = proc::mergeSums(accumulator.sums());
    if (!merged) return merged.error();
    const std::optional<LightStep> step = lightStep(state, accumulator.sums(), *merged);
    Processed done{
        .signal = glare.bin(*merged, binning),
        .raw = {.merged = std::move(*merged), .bracket = describeBracket(frames, state.band)},
        .lightStep = step,
        .compute = {}};
    done.compute = processing.elapsed();
    return done;
}

Gathering::Gathering(driver::Rig& rig, const Processing& processing)
    : rig_(rig), processing_(processing) {
    captured_.signals.resize(rig.identify().ledAngles.size());
}

Result<void> Gathering::add(State state, std::vector<Frame> frames) {
    if (Result<void> last = settle(); !last) return last;
    state_ = state;
    running_.emplace(
        [this, state, frames = std::move(frames)] { return processing_(state, frames); });
    return {};
}

Result<void> Gathering::settle() {
    if (!running_) return {};
    Result<Processed> done = running_->await(rig_);
    running_.reset();
    if (!done) return done.error();
    captured_.compute += done->compute;
    chiSquare_ += done->raw.merged.chiSquare;
    freedom_ += static_cast<double>(done->raw.merged.freedom);
    captured_.signals[static_cast<std::size_t>(state_.led)][index(state_.band)] =
        std::move(done->signal);
    if (done->lightStep) captured_.lightSteps.push_back(*done->lightStep);
    captured_.raw.states.push_back(std::move(done->raw));
    return {};
}

Result<Captured> Gathering::finish() {
    if (Result<void> last = settle(); !last) return last.error();
    captured_.chiSquarePerFreedom = freedom_ > 0 ? chiSquare_ / freedom_ : 1;
    return std::move(captured_);
}

}  // namespace gonio::daemon
