#include "daemon/planned_run.h"

#include <algorithm>
#include <utility>

#include "daemon/then_dark.h"
#include "proc/plan/shared_choice.h"
#include "proc/radiance/merge.h"

namespace gonio::daemon {
namespace {

constexpr int kFirstDarks = 2;  // of each of the pilots' exposures, while the host plans

Microseconds asked(Seconds exposure) { return std::chrono::round<Microseconds>(exposure); }

KnownShot shotOf(std::optional<State> state, const proc::ShotKind& kind, int frames) {
    return {.state = state,
            .shot = {.level = kind.level, .exposure = asked(kind.exposure)},
            .frames = frames};
}

/// What the sensor's figures say of the dark: good enough to plan by.
proc::DarkLibrary nominalDarks(const std::vector<Frame>& frames, const proc::SensorModel& sensor) {
    proc::DarkLibrary library;
    const proc::SensorNoise noise = sensor.noiseNow();
    for (const Frame& frame : frames) {
        Image<float> mean(frame.pixels.size());
        const double electrons = noise.darkElectronsPerSecond * frame.exposure.seconds();
        std::fill(mean.pixels().begin(),
                  mean.pixels().end(),
                  static_cast<float>(sensor.blackDn + electrons / noise.electronsPerDn));
        library.add({.mean = std::move(mean),
                     .varianceOfMean = 0,
                     .hot = {},
                     .exposure = frame.exposure,
                     .window = frame.window,
                     .gainDb = frame.gainDb,
                     .frames = 1});
    }
    return library;
}

double sensorCelsius(const Frame& frame) {
    constexpr double kUsual = 25;
    return frame.celsius[Frame::Sensor].value_or(kUsual);
}

}  // namespace

PlannedRun::PlannedRun(const Bench& bench,
                       const RigReferences& references,
                       const proc::PlanGoal& goal)
    : bench_(bench),
      references_(references),
      goal_(goal),
      sequencer_(bench.rig, bench.profile, bench.nextPlanStep, bench.alive),
      states_(sequencer_.states()),
      responsivities_(references, bench.rig.identify().ledAngles),
      floor_(floorOf(references)),
      rig_(rigModel(bench.rig.identify(), bench.profile, proc::SensorModel{}.celsius)),
      pilots_(states_.size()) {}

int PlannedRun::steps() const {
    const std::size_t planning = states_.size() + proc::pilotExposures(rig_).size();
    if (!plan_) return static_cast<int>(planning);
    return static_cast<int>(planning + plan_->darks.size() + states_.size() + 1);
}

proc::PlanInput PlannedRun::input() const {
    return {.rig = rig_, .states = learnt_, .floor = floor_};
}

std::vector<KnownShot> PlannedRun::pilotShots(State state) const {
    std::vector<KnownShot> shots;
    for (const proc::ShotKind& kind : rig_.pilotShots()) shots.push_back(shotOf(state, kind, 1));
    return shots;
}

/// The dark library is of this window, and of all exposures that may be planned.
bool PlannedRun::holdsDarks(const Window& window) const {
    std::vector<Seconds> wanted = proc::pilotExposures(rig_);
    wanted.insert(wanted.end(), rig_.exposures.begin(), rig_.exposures.end());
    return std::all_of(wanted.begin(), wanted.end(), [&](Seconds exposure) {
        return std::any_of(
            bench_.darks.begin(), bench_.darks.end(), [&](const proc::DarkFrame& dark) {
                return dark.window == window && dark.exposure.requested == asked(exposure);
            });
    });
}

Result<const proc::Plan*> PlannedRun::plan() {
    const Result<Window> window = configureWindow(bench_.rig);
    if (!window) return window.error();
    if (Result<void> fit = fits(bench_.corrections, *window); !fit) return fit.error();
    if (holdsDarks(*window)) rig_.darkFramesHeld = bench_.darks.front().frames;
    seeing_.emplace([this, window = *window]() -> Result<void> {
        const proc::LensMap& map = references_.lens.fit.map;
        binning_.emplace(map, window, kField);
        glare_.emplace(bench_.glare.value_or(proc::GlareSpread{}), map, window, kField);
        return {};
    });
    if (Result<void> taken = takePilots(); !taken) return taken.error();
    return &*plan_;
}

/// Pilots state by state, each learnt from beside the next; then dark frames, beside the planning.
Result<void> PlannedRun::takePilots() {
    std::vector<KnownShot> shots;
    for (const State state : states_) {
        for (const KnownShot& shot : pilotShots(state)) shots.push_back(shot);
    }
    const std::size_t pilots = shots.size(), perState = pilots / states_.size();
    for (const Seconds exposure : proc::pilotExposures(rig_))
        shots.push_back(shotOf({}, {.exposure = exposure}, kFirstDarks));
    std::optional<Alongside<proc::Plan>> planning;
    const Result<void> taken =
        sequencer_.take(shots,
                        {.frame = [&](std::size_t shot, Frame&& frame) -> Result<void> {
                             if (shot >= pilots) return addDark(shots[shot].shot.exposure, frame);
                             if (shot == 0) rig_.sensor.celsius = sensorCelsius(frame);
                             pilots_[shot / perState].push_back(std::move(frame));
                             return {};
                         },
                         .done = [&](std::size_t shot) -> Result<void> {
                             const std::size_t state = shot / perState;
                             if (shot < pilots && (shot + 1) % perState != 0) return {};
                             if (shot < pilots) {
                                 if (Result<void> on = learn(state); !on) return on;
                                 return bench_.step("pilot of " + stateName(states_[state]));
                             }
                             if (shot == pilots) {
                                 if (Result<void> last = settle(); !last) return last;
                                 planning.emplace([this]() -> Result<proc::Plan> {
                                     return proc::planCaptures(input(), goal_);
                                 });
                             }
                             return bench_.step("dark frames, planning");
                         }});
    if (!taken) return taken;
    const Stopwatch waiting(bench_.clock);
    Result<proc::Plan> plan = planning->await(bench_.rig, bench_.alive);
    if (!plan) return plan.error();
    compute_ += waiting.elapsed();
    plan_ = std::move(*plan);
    return {};
}

/// Begins to learn from a state's pilots, once what is being learnt is known.
Result<void> PlannedRun::learn(std::size_t state) {
    if (seeing_) {
        const Result<void> seen = seeing_->await(bench_.rig, bench_.alive);
        seeing_.reset();
        if (!seen) return seen;
    }
    if (Result<void> last = settle(); !last) return last;
    learning_.emplace([this, state]() -> Result<proc::StatePilot> {
        const State of = states_[state];
        const std::vector<Frame>& frames = pilots_[state];
        const auto merged =
            proc::merge(frames, of.band, nominalDarks(frames, rig_.sensor), bench_.profile.noise);
        if (!merged) return merged.error();
        return proc::StatePilot{
            .led = of.led,
            .band = of.band,
            .cells = proc::pilotCells(
                glare_->bin(*merged, *binning_), responsivities_.of(of), *binning_)};
    });
    return {};
}

Result<void> PlannedRun::settle() {
    if (!learning_) return {};
    Result<proc::StatePilot> learnt = learning_->await(bench_.rig, bench_.alive);
    learning_.reset();
    if (!learnt) return learnt.error();
    learnt_.push_back(std::move(*learnt));
    return {};
}

Result<void> PlannedRun::addDark(Microseconds exposure, const Frame& frame) {
    const auto sums = darkSums_.try_emplace(exposure, bench_.profile.noise).first;
    ++darksTaken_[exposure];
    return sums->second.add(frame);
}

Result<Captured> PlannedRun::capture() {
    if (Result<void> dark = takeDarks(); !dark) return thenDark(bench_.rig, dark.error());
    return thenDark(bench_.rig, takeStates());
}

Result<void> PlannedRun::takeDarks() {
    std::vector<KnownShot> shots;
    for (const proc::DarkCapture& dark : plan_->darks) {
        const int more = dark.frames - darksTaken_[asked(dark.exposure)];
        if (more > 0) shots.push_back(shotOf({}, {.exposure = dark.exposure}, more));
    }
    const Result<void> taken = sequencer_.take(
        shots,
        {.frame = [&](std::size_t shot,
                      const Frame& frame) { return addDark(shots[shot].shot.exposure, frame); },
         .done = [&](std::size_t) { return bench_.step("dark frames"); }});
    if (!taken) return taken;
    std::map<Microseconds, const proc::DarkFrame*> held;
    if (rig_.darkFramesHeld > 0) {
        for (const proc::DarkFrame& dark : bench_.darks) {
            held[dark.exposure.requested] = &dark;
            darks_.add(dark);
        }
    }
    for (const auto& [exposure, sums] : darkSums_) {
        Result<proc::DarkFrame> dark = sums.mean();
        if (!dark) return dark.error();
        freshDarks_.add(*dark);
        const auto same = held.find(exposure);
        const bool alike = same != held.end() && same->second->window == dark->window &&
                           same->second->gainDb == dark->gainDb &&
                           same->second->exposure.granted == dark->exposure.granted;
        darks_.add(alike ? proc::pooled(*same->second, *dark) : std::move(*dark));
    }
    darkSums_.clear();
    return {};
}

Result<Captured> PlannedRun::takeStates() {
    Gathering gathering(
        bench_.rig,
        {.darks = darks_,
         .binning = *binning_,
         .glare = *glare_,
         .corrections = bench_.corrections,
         .profile = bench_.profile,
         .clock = bench_.clock,
         .white = whiteRates(references_.white.signals, pilots_.front().front().window)});
    std::vector<KnownShot> shots;
    std::vector<std::size_t> stateOf;  // of each shot; behind the last: the repeated pilots
    const auto list = [&](std::size_t state, const KnownShot& shot) {
        shots.push_back(shot);
        stateOf.push_back(state);
    };
    for (std::size_t s = 0; s < states_.size(); ++s) {
        for (const proc::PlannedCapture& planned : plan_->states[s].captures)
            list(s, shotOf(states_[s], planned.shot, planned.frames));
    }
    for (const KnownShot& shot : pilotShots(states_.front())) list(states_.size(), shot);

    std::size_t open = 0;  // the state at hand
    const auto begin = [&]() -> Result<void> {
        gathering.begin(states_[open]);
        for (const Frame& pilot : pilots_[open])
            if (Result<void> added = gathering.add(pilot); !added) return added;
        if (open > 0) pilots_[open] = {};  // the first state's are compared with at the end
        return {};
    };
    // All states before `state` are complete, and it begins.
    const auto advanceTo = [&](std::size_t state) -> Result<void> {
        while (open < state) {
            if (Result<void> ended = gathering.end(); !ended) return ended;
            if (Result<void> on = bench_.step(stateName(states_[open])); !on) return on;
            if (++open == states_.size()) return {};
            if (Result<void> begun = begin(); !begun) return begun;
        }
        return {};
    };
    std::vector<Frame> again;
    if (Result<void> begun = begin(); !begun) return begun.error();
    const Result<void> taken = sequencer_.take(
        shots,
        {.frame = [&](std::size_t shot, Frame&& frame) -> Result<void> {
             if (Result<void> on = advanceTo(stateOf[shot]); !on) return on;
             if (stateOf[shot] < states_.size()) return gathering.add(frame);
             again.push_back(std::move(frame));
             return {};
         },
         .done = [&](std::size_t shot) -> Result<void> {
             const bool last = shot + 1 == shots.size() || stateOf[shot + 1] != stateOf[shot];
             if (last) tellOutlook(shot + 1);
             return {};
         }});
    if (!taken) return taken.error();
    Result<Captured> captured = gathering.finish();
    if (!captured) return captured;
    const Stopwatch comparing(bench_.clock);
    Result<Repeat> repeat = alongside(bench_.rig, bench_.alive, [&] { return repeated(again); });
    if (!repeat) return repeat.error();
    captured->repeat = std::move(*repeat);
    captured->compute += compute_ + comparing.elapsed();
    captured->darks = std::move(darks_);
    captured->freshDarks = std::move(freshDarks_);
    if (Result<void> on = bench_.step(stateName(states_.front()) + " again"); !on)
        return on.error();
    return captured;
}

Result<Repeat> PlannedRun::repeated(const std::vector<Frame>& again) const {
    const State state = states_.front();
    const auto signalOf = [&](const std::vector<Frame>& frames) -> Result<proc::CellSignal> {
        auto merged =
            proc::merge(frames, state.band, darks_, bench_.profile.noise, bench_.profile.response);
        if (!merged) return merged.error();
        proc::RawState raw{.merged = std::move(*merged), .bracket = {}};
        for (const Frame& frame : frames) note(frame, state.band, raw.bracket);
        return daemon::signalOf(raw, bench_.corrections, *glare_, *binning_);
    };
    Result<proc::CellSignal> first = signalOf(pilots_.front());
    if (!first) return first.error();
    Result<proc::CellSignal> last = signalOf(again);
    if (!last) return last.error();
    return Repeat{.state = state, .first = std::move(*first), .last = std::move(*last)};
}

void PlannedRun::tellOutlook(std::size_t capturesTaken) const {
    bench_.outlook(proc::progressOf(input(),
                                    *plan_,
                                    {.pilots = plan_->pilots.size() * states_.size(),
                                     .darks = plan_->darks.size(),
                                     .captures = capturesTaken}));
}

proc::Prediction PlannedRun::achieved(const Captured& captured) const {
    return daemon::achieved(captured.signals, responsivities_, floor_, goal_.fMin);
}

}  // namespace gonio::daemon
