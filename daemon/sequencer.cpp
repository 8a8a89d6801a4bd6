#include "daemon/sequencer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gonio::daemon {
namespace {

constexpr double kFullLevel = 65535;

/// Without its plan step.
driver::CaptureRequest toTake(std::optional<State> state, const Shot& shot, int frames) {
    if (!state) return {.exposure = shot.exposure, .frames = frames};
    const auto drive = static_cast<std::uint16_t>(std::lround(shot.level * kFullLevel));
    return {.led = state->led,
            .levels = LedLevels::only(state->band, std::max<std::uint16_t>(1, drive)),
            .exposure = shot.exposure,
            .frames = frames};
}

}  // namespace

Sequencer::Sequencer(driver::Rig& rig,
                     const RigProfile& profile,
                     std::uint64_t& nextPlanStep,
                     Attendance attendance)
    : rig_(rig),
      profile_(profile),
      nextPlanStep_(nextPlanStep),
      attendance_(std::move(attendance)),
      leds_(static_cast<int>(rig.identify().ledAngles.size())),
      brackets_(rig, profile, nextPlanStep, attendance_) {}

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

Result<driver::Capture> Sequencer::capture(const driver::CaptureRequest& request,
                                           const driver::ArmAhead& ahead,
                                           const driver::FrameSink& sink) {
    attendance_.alive();
    driver::FrameSink attended;
    if (sink) {
        attended = [&](Frame&& frame) {
            attendance_.alive();
            return sink(std::move(frame));
        };
    }
    Result<driver::Capture> taken = rig_.capture(request, ahead, attended);
    if (taken && taken->recaptures > 0) brackets_.rejected(taken->evidence);
    return taken;
}

/// Each attempt by the same plan steps.
template <class Take>
Result<void> Sequencer::whole(State state, Take take) {
    const std::uint64_t step = nextPlanStep_;
    const auto prepared = prepared_;
    return brackets_.take(state, [&] {
        nextPlanStep_ = step;
        prepared_ = prepared;
        return take();
    });
}

Result<std::vector<Frame>> Sequencer::expose(State state,
                                             double level,
                                             Microseconds exposure,
                                             int frames) {
    std::vector<Frame> all;
    const Result<void> taken = whole(state, [&]() -> Result<void> {
        all.clear();
        const auto one =
            capture(numbered(toTake(state, {.level = level, .exposure = exposure}, frames)),
                    {},
                    [&](Frame&& frame) -> Result<void> {
                        if (auto sound = brackets_.look(state, frame); !sound) return sound;
                        all.push_back(std::move(frame));
                        return {};
                    });
        return one ? Result<void>() : one.error();
    });
    if (!taken) return taken.error();
    return all;
}

Result<void> Sequencer::bracket(State state,
                                const BracketPlan& plan,
                                const BracketSink& sink,
                                std::optional<State> then) {
    return whole(state, [&] { return climb(state, plan, sink, then); });
}

Result<void> Sequencer::climb(State state,
                              const BracketPlan& plan,
                              const BracketSink& sink,
                              std::optional<State> then) {
    if (Result<void> begun = sink.begin(); !begun) return begun;
    BracketLadder ladder(profile_, plan);
    NextShot now = ladder.advance();
    driver::CaptureRequest wanted = begin(toTake(state, now.shot, plan.frames));
    while (now.outlook == Outlook::Shot) {
        NextShot next = ladder.advance();
        driver::ArmAhead ahead;
        if (next.outlook == Outlook::Shot)
            ahead.next = numbered(toTake(state, next.shot, plan.frames));
        if (next.outlook == Outlook::Over && then) ahead.next = prepare(*then, plan);
        Result<driver::Capture> taken = capture(wanted, ahead);
        if (!taken) return taken.error();
        ladder.seen(taken->frames);
        for (Frame& frame : taken->frames) {
            if (Result<void> sound = brackets_.look(state, frame); !sound) return sound;
            if (Result<void> given = sink.frame(std::move(frame)); !given) return given;
        }
        if (next.outlook == Outlook::Shot) {
            wanted = *ahead.next;
        } else if (next = ladder.advance(); next.outlook == Outlook::Shot) {
            wanted = numbered(toTake(state, next.shot, plan.frames));
        }
        now = next;
    }
    return {};
}

Result<void> Sequencer::take(std::span<const KnownShot> shots, const ShotSink& sink) {
    std::vector<driver::CaptureRequest> requests;
    requests.reserve(shots.size());
    for (const KnownShot& known : shots) {
        driver::CaptureRequest request = toTake(known.state, known.shot, known.frames);
        if (known.planStep) request.planStep = *known.planStep;
        requests.push_back(known.planStep ? request : numbered(request));
    }
    for (std::size_t first = 0; first < shots.size();) {
        const Result<void> taken =
            brackets_.take(shots[first].state, [&] { return shoot(shots, requests, sink, first); });
        if (!taken) return taken.error();
        do ++first;
        while (first < shots.size() && shots[first].joins);
    }
    return {};
}

/// The bracket that the first of these shots opens.
Result<void> Sequencer::shoot(std::span<const KnownShot> shots,
                              std::span<const driver::CaptureRequest> requests,
                              const ShotSink& sink,
                              std::size_t first) {
    if (Result<void> begun = sink.begin(first); !begun) return begun;
    for (std::size_t i = first; i < shots.size() && (i == first || shots[i].joins); ++i) {
        driver::ArmAhead ahead;
        if (i + 1 < requests.size()) ahead.next = requests[i + 1];
        const auto taken = capture(requests[i], ahead, [&](Frame&& frame) -> Result<void> {
            if (Result<void> sound = brackets_.look(shots[i].state, frame); !sound) return sound;
            return sink.frame(i, std::move(frame));
        });
        if (!taken) return taken.error();
        if (Result<void> on = sink.done(i); !on) return on;
    }
    return {};
}

Result<proc::DarkLibrary> Sequencer::darks(int frames, const std::function<Result<void>()>& done) {
    std::vector<KnownShot> shots;
    shots.reserve(profile_.exposures.size());
    for (const Microseconds exposure : profile_.exposures)
        shots.push_back({.state = {}, .shot = {.exposure = exposure}, .frames = frames});
    proc::DarkLibrary library;
    proc::DarkAverage average(profile_.noise);
    const Result<void> taken =
        take(shots,
             {.frame = [&](std::size_t, const Frame& frame) { return average.add(frame); },
              .done = [&](std::size_t) -> Result<void> {
                  Result<proc::DarkFrame> dark = average.mean();
                  if (!dark) return dark.error();
                  library.add(std::move(*dark));
                  return done();
              },
              .begin = [&](std::size_t) -> Result<void> {
                  average = proc::DarkAverage(profile_.noise);
                  return {};
              }});
    if (!taken) return taken.error();
    return library;
}

}  // namespace gonio::daemon
