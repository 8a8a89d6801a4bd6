#include "daemon/gathering.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proc/radiance/group_scales.h"

namespace gonio::daemon {
namespace {

constexpr double kSmallest = 5e-4, kSigmas = 4;  // of offsets of effective times

/// How well the effective times are known beforehand: the light wanders between captures.
proc::NominalUncertainty nominalOf(const RigProfile& profile) {
    proc::NominalUncertainty nominal;
    nominal.relative = std::max(nominal.relative, profile.ledDrift);
    return nominal;
}

/// Something is off by more than noise, by so much that it matters, and by no more than a rig can
/// be off: beyond that it is another light or another picture.
bool worthCorrecting(const proc::ScaleReport& report) {
    const auto plausible = [](const proc::GroupScale& group) {
        return std::abs(group.offset.size) < kSigmas * group.uNominal;
    };
    const auto off = [](const proc::GroupScale& group) {
        return std::abs(group.offset.size) > std::max(kSmallest, kSigmas * group.offset.u);
    };
    return std::all_of(report.groups.begin(), report.groups.end(), plausible) &&
           std::any_of(report.groups.begin(), report.groups.end(), off);
}

void describe(const proc::ScaleReport& report, bool corrected, proc::RawExposure& exposure) {
    for (const proc::GroupScale& group : report.groups) {
        if (group.granted != exposure.granted || group.level != exposure.level) continue;
        if (corrected) exposure.scale = 1 + group.offset.size;
        exposure.uScale = group.offset.u;
    }
}

}  // namespace

void note(const Frame& frame, Band band, std::vector<proc::RawExposure>& bracket) {
    if (bracket.empty() || bracket.back().captureId != frame.captureId) {
        bracket.push_back({.captureId = frame.captureId,
                           .granted = frame.exposure.granted,
                           .level = frame.levels[band],
                           .frames = 0,
                           .blackLevel = frame.blackLevel,
                           .celsius = frame.celsius});
    }
    proc::RawExposure& exposure = bracket.back();
    const std::size_t b = index(band);
    const double milliamp = (frame.currentMinMilliamp[b] + frame.currentMaxMilliamp[b]) / 2;
    exposure.milliamp += (milliamp - exposure.milliamp) / ++exposure.frames;
}

Result<Processed> Processing::operator()(State state,
                                         proc::MergeAccumulator& sums,
                                         std::vector<proc::RawExposure> exposures) const {
    const Stopwatch processing(clock);
    Result<proc::MergedState> merged = proc::mergeSums(sums.sums());
    if (!merged) return merged.error();
    const std::optional<LightStep> step =
        lightStep(state, sums.sums(), *merged, profile.quality.lightStep);
    const proc::ScaleReport scales = proc::groupScales(sums.sums(), *merged, nominalOf(profile));
    const bool correct = !step && worthCorrecting(scales);
    if (correct) {
        proc::correctScales(sums, scales);
        merged = proc::mergeSums(sums.sums());
        if (!merged) return merged.error();
    }
    for (proc::RawExposure& exposure : exposures) describe(scales, correct, exposure);
    Processed done{.signal = {},
                   .raw = {.merged = std::move(*merged), .bracket = std::move(exposures)},
                   .lightStep = step,
                   .compute = {}};
    done.signal = signalOf(done.raw, corrections, glare, binning);
    done.compute = processing.elapsed();
    return done;
}

proc::MergeAccumulator Processing::accumulator() const {
    return {Band::R, darks, profile.noise, profile.response};
}

Gathering::Gathering(driver::Rig& rig, const Attendance& attendance, const Processing& processing)
    : rig_(rig),
      attendance_(attendance),
      processing_(processing),
      brackets_{{{{}, processing.accumulator(), {}}, {{}, processing.accumulator(), {}}}} {
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
    note(frame, bracket.state.band, bracket.exposures);
    Result<void> added = bracket.sums.add(frame);
    adding_ += adding.elapsed();
    return added;
}

Result<void> Gathering::end() {
    if (Result<void> last = settle(); !last) return last;
    captured_.compute += std::exchange(adding_, Seconds(0));
    Bracket& bracket = atHand();
    ++states_;
    running_.emplace(
        [this, &bracket] { return processing_(bracket.state, bracket.sums, bracket.exposures); });
    return {};
}

Result<void> Gathering::settle() {
    if (!running_) return {};
    Result<Processed> done = running_->await(rig_, attendance_.alive);
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
