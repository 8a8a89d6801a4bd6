#include "daemon/sequencer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace gonio::daemon {
namespace {

constexpr double kFullLevel = 65535;

/// Without its plan step.
driver::CaptureRequest toTake(State state, const Shot& shot, int frames) {
    const auto drive = static_cast<std::uint16_t>(std::lround(shot.level * kFullLevel));
    return {.led = state.led,
            .levels = LedLevels::only(state.band, std::max<std::uint16_t>(1, drive)),
            .exposure = shot.exposure,
            .frames = frames};
}

}  // namespace

std::string stateName(State state) {
    return "LED " + std::to_string(state.led) + " " + std::string(letter(state.band));
}

BracketPlan sampleBracket(Effort effort) {
    switch (effort) {
        case Effort::Draft: return {.frames = 1, .longest = 4};
        case Effort::Standard: return {.frames = 1};
        case Effort::Reference: return {.frames = 8};
    }
    return {};
}

Sequencer::Sequencer(driver::Rig& rig,
                     const RigProfile& profile,
                     std::uint64_t& nextPlanStep,
                     std::function<void()> alive)
    : rig_(rig),
      profile_(profile),
      nextPlanStep_(nextPlanStep),
      alive_(std::move(alive)),
      leds_(static_cast<int>(rig.identify().ledAngles.size())) {}

std::vector<State> Sequencer::states() const {
    std::vector<State> all;
    for (int led = 0; led < leds_; ++led) {
        for (Band band : kBands) all.push_back({led, band});
    }
    return all;
}

driver::CaptureRequest Sequencer::numbered(driver::CaptureRequest request) {
    request.planStep = nextPlanStep_++;
    return request;
}

/// The one that was prepared, if this is it: it may be on its way already.
driver::CaptureRequest Sequencer::begin(driver::CaptureRequest first) {
    if (const auto ready = std::exchange(prepared_, std::nullopt)) {
        first.planStep = ready->planStep;
        if (first == *ready) return first;
    }
    return numbered(first);
}

driver::CaptureRequest Sequencer::prepare(State state, const BracketPlan& plan) {
    if (!prepared_) {
        const Shot first = BracketLadder(profile_, plan).advance().shot;
        prepared_ = numbered(toTake(state, first, plan.frames));
    }
    return *prepared_;
}

Result<driver::Capture> Sequencer::take(const driver::CaptureRequest& request,
                                        const driver::ArmAhead& ahead) {
    alive_();
    return rig_.capture(request, ahead);
}

Result<std::vector<Frame>> Sequencer::expose(State state,
                                             double level,
                                             Microseconds exposure,
                                             int frames) {
    Result<driver::Capture> capture =
        take(numbered(toTake(state, {.level = level, .exposure = exposure}, frames)));
    if (!capture) return capture.error();
    return std::move(capture->frames);
}

Result<std::vector<Frame>> Sequencer::bracket(State state,
                                              const BracketPlan& plan,
                                              std::optional<State> then) {
    BracketLadder ladder(profile_, plan);
    std::vector<Frame> all;
    NextShot now = ladder.advance();
    driver::CaptureRequest wanted = begin(toTake(state, now.shot, plan.frames));
    while (now.outlook == Outlook::Shot) {
        NextShot next = ladder.advance();
        driver::ArmAhead ahead;
        if (next.outlook == Outlook::Shot)
            ahead.next = numbered(toTake(state, next.shot, plan.frames));
        if (next.outlook == Outlook::Over && then) ahead.next = prepare(*then, plan);
        Result<driver::Capture> capture = take(wanted, ahead);
        if (!capture) return capture.error();
        ladder.seen(capture->frames);
        std::move(capture->frames.begin(), capture->frames.end(), std::back_inserter(all));
        if (next.outlook == Outlook::Shot) {
            wanted = *ahead.next;
        } else if (next = ladder.advance(); next.outlook == Outlook::Shot) {
            wanted = numbered(toTake(state, next.shot, plan.frames));
        }
        now = next;
    }
    return all;
}

Result<std::vector<proc::DarkFrame>> Sequencer::darks(int frames,
                                                      const std::function<Result<void>()>& done) {
    std::vector<driver::CaptureRequest> requests;
    requests.reserve(profile_.exposures.size());
    for (Microseconds exposure : profile_.exposures)
        requests.push_back(numbered({.exposure = exposure, .frames = frames}));
    std::vector<proc::DarkFrame> darks;
    for (std::size_t i = 0; i < requests.size(); ++i) {
        driver::ArmAhead ahead;
        if (i + 1 < requests.size()) ahead.next = requests[i + 1];
        const auto taken = take(requests[i], ahead);
        if (!taken) return taken.error();
        Result<proc::DarkFrame> dark = proc::averageDark(taken->frames, profile_.noise);
        if (!dark) return dark.error();
        darks.push_back(std::move(*dark));
        if (Result<void> on = done(); !on) return on.error();
    }
    return darks;
}

}  // namespace gonio::daemon
