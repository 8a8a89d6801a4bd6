#include "daemon/gathering.h"

#include <utility>

namespace gonio::daemon {
namespace {

void describe(const Frame& frame, Band band, std::vector<proc::RawExposure>& bracket) {
    if (bracket.empty() || bracket.back().captureId != frame.captureId) {
        bracket.push_back({.captureId = frame.captureId,
                           .granted = frame.exposure.granted,
                           .level = frame.levels[band],
                           .frames = 0,
                           .blackLevel = frame.blackLevel,
                           .celsius = frame.celsius});
    }
    ++bracket.back().frames;
}

}  // namespace

Result<Processed> Processing::operator()(State state, const proc::BracketSums& sums) const {
    const Stopwatch processing(clock);
    Result<proc::MergedState> merged = proc::mergeSums(sums);
    if (!merged) return merged.error();
    const std::optional<LightStep> step = lightStep(state, sums, *merged);
    Processed done{.signal = binning.bin(*merged),
                   .raw = {.merged = std::move(*merged), .bracket = {}},
                   .lightStep = step,
                   .compute = {}};
    done.compute = processing.elapsed();
    return done;
}

Gathering::Gathering(driver::Rig& rig, const Processing& processing)
    : rig_(rig),
      processing_(processing),
      brackets_{{{{}, {Band::R, processing.darks, processing.noise}, {}},
                 {{}, {Band::R, processing.darks, processing.noise}, {}}}} {
    captured_.signals.resize(rig.identify().ledAngles.size());
}

void Gathering::begin(State state) {
    Bracket& bracket = atHand();
    bracket.state = state;
    bracket.sums.restart(state.band);
    bracket.exposures.clear();
}

Result<void> Gathering::add(const Frame& frame) {
    const Stopwatch adding(processing_.clock);
    Bracket& bracket = atHand();
    describe(frame, bracket.state.band, bracket.exposures);
    Result<void> added = bracket.sums.add(frame);
    adding_ += adding.elapsed();
    return added;
}

Result<void> Gathering::end() {
    if (Result<void> last = settle(); !last) return last;
    captured_.compute += std::exchange(adding_, Seconds(0));
    const Bracket& bracket = atHand();
    ++states_;
    running_.emplace([this, &bracket]() -> Result<Processed> {
        Result<Processed> done = processing_(bracket.state, bracket.sums.sums());
        if (done) done->raw.bracket = bracket.exposures;
        return done;
    });
    return {};
}

Result<void> Gathering::settle() {
    if (!running_) return {};
    Result<Processed> done = running_->await(rig_);
    running_.reset();
    if (!done) return done.error();
    captured_.compute += done->compute;
    const proc::MergedState& merged = done->raw.merged;
    chiSquare_ += merged.chiSquare;
    freedom_ += static_cast<double>(merged.freedom);
    captured_.signals[static_cast<std::size_t>(merged.led)][index(merged.band)] =
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
