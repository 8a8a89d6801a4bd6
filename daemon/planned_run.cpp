#include "daemon/planned_run.h"

#include <algorithm>
#include <utility>

#include "daemon/then_dark.h"
#include "proc/plan/shared_choice.h"
#include "proc/radiance/merge.h"

namespace gonio::daemon {
namespace {

constexpr int kUnsound = -1;    // breaks of pilots that are not to be used
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

/// A binned pixel's rate is the mean of its members'; the rig model counts all their electrons.
void gatherMembers(std::vector<proc::PlanCell>& cells, int binning) {
    for (proc::PlanCell& cell : cells) {
        cell.rate *= binning * binning;
        cell.background *= binning * binning;
    }
}

/// Seconds on a slow computer, in which nothing else would feed the rig's heartbeat.
Responsivities responsivitiesBeside(const Bench& bench, const RigReferences& references) {
    const std::vector<Radians> angles = bench.rig.identify().ledAngles;
    const auto work = [&] { return Responsivities(references, angles); };
    auto made = alongside(bench.rig, bench.attendance.alive, work);
    return made ? std::move(*made) : work();
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
      sequencer_(bench.rig, bench.profile, bench.nextPlanStep, bench.attendance),
      states_(sequencer_.states()),
      responsivities_(responsivitiesBeside(bench, references)),
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
    for (const proc::ShotKind& kind : rig_.pilotShots()) {
        shots.push_back(shotOf(state, kind, 1));
        shots.back().joins = shots.size() > 1;
    }
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
    if (holdsDarks(*window)) {
        rig_.darkFramesHeld = bench_.darks.front().frames;
        for (const proc::DarkFrame& dark : bench_.darks) darks_.add(dark);
        expectLight(*window);
    }
    seeing_.emplace([this, window = *window]() -> Result<void> {
        const proc::LensMap& map = references_.lens.fit.map;
        binning_.emplace(map, window, kField);
        glare_.emplace(bench_.glare.value_or(proc::GlareSpread{}), map, window, kField);
        return {};
    });
    if (Result<void> taken = takePilots(); !taken) return taken.error();
    return &*plan_;
}

/// By `darks_`: from now on a pilot, or a capture, must show some light.
void PlannedRun::expectLight(const Window& window, const proc::DarkLibrary* ofThisRun) {
    sequencer_.watch().expect(darks_, whiteRates(references_.white.signals, window), ofThisRun);
}

/// Pilots state by state, each learnt from beside the next; then dark frames, beside the planning.
Result<void> PlannedRun::takePilots() {
    std::vector<KnownShot> shots;
    for (std::size_t state = 0; state < states_.size(); ++state) {
        pilots_[state].shots = pilotShots(states_[state]);
        for (KnownShot& shot : pilots_[state].shots) {
            shot.planStep = bench_.nextPlanStep++;
            shots.push_back(shot);
        }
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
                             pilots_[shot / perState].frames.push_back(std::move(frame));
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
                         },
                         .begin = [&](std::size_t shot) -> Result<void> {
                             if (shot < pilots) {
                                 beginPilots(shot / perState);
                             } else {
                                 beginDark(shots[shot].shot.exposure);
                             }
                             return {};
                         }});
    if (!taken) return taken.error();
    const Stopwatch waiting(bench_.clock);
    Result<proc::Plan> plan = planning->await(bench_.rig, bench_.attendance.alive);
    if (!plan) return plan.error();
    compute_ += waiting.elapsed();
    plan_ = std::move(*plan);
    return {};
}

void PlannedRun::beginPilots(std::size_t state) {
    if (learnt_.size() == state) learning_.reset();  // reads those that are void now
    pilots_[state].frames.clear();
    pilots_[state].breaks = sequencer_.breaks();
}

/// Begins to learn from a state's pilots, once what is being learnt is known.
Result<void> PlannedRun::learn(std::size_t state) {
    if (seeing_) {
        const Result<void> seen = seeing_->await(bench_.rig, bench_.attendance.alive);
        seeing_.reset();
        if (!seen) return seen.error();
    }
    if (Result<void> last = settle(); !last) return last;
    learning_.emplace([this, state]() -> Result<proc::StatePilot> {
        const State of = states_[state];
        const std::vector<Frame>& frames = pilots_[state].frames;
        const auto merged =
            proc::merge(frames, of.band, nominalDarks(frames, rig_.sensor), bench_.profile.noise);
        if (!merged) return merged.error();
        auto cells =
            proc::pilotCells(glare_->bin(*merged, *binning_), responsivities_.of(of), *binning_);
        gatherMembers(cells, merged->window.binning);
        return proc::StatePilot{.led = of.led, .band = of.band, .cells = std::move(cells)};
    });
    return {};
}

Result<void> PlannedRun::settle() {
    if (!learning_) return {};
    Result<proc::StatePilot> learnt = learning_->await(bench_.rig, bench_.attendance.alive);
    learning_.reset();
    if (!learnt) return learnt.error();
    learnt_.push_back(std::move(*learnt));
    return {};
}

/// Once more for the same exposure: what was added since is void.
void PlannedRun::beginDark(Microseconds exposure) {
    DarkSums& now =
        darkSums_.try_emplace(exposure, DarkSums{proc::DarkAverage(bench_.profile.noise)})
            .first->second;
    if (darksBefore_ && darksBefore_->first == exposure) {
        now = darksBefore_->second;
    } else {
        darksBefore_.emplace(exposure, now);
    }
}

Result<void> PlannedRun::addDark(Microseconds exposure, const Frame& frame) {
    DarkSums& now = darkSums_.at(exposure);
    ++now.frames;
    return now.sums.add(frame);
}

Result<Captured> PlannedRun::capture() {
    Result<void> dark = takeDarks();
    return thenDark(bench_, dark ? takeStates() : Result<Captured>(dark.error()));
}

Result<void> PlannedRun::takeDarks() {
    darksBefore_.reset();
    std::vector<KnownShot> shots;
    for (const proc::DarkCapture& dark : plan_->darks) {
        const auto some = darkSums_.find(asked(dark.exposure));
        const int more = dark.frames - (some == darkSums_.end() ? 0 : some->second.frames);
        if (more > 0) shots.push_back(shotOf({}, {.exposure = dark.exposure}, more));
    }
    const Result<void> taken = sequencer_.take(
        shots,
        {.frame = [&](std::size_t shot,
                      const Frame& frame) { return addDark(shots[shot].shot.exposure, frame); },
         .done = [&](std::size_t) { return bench_.step("dark frames"); },
         .begin = [&](std::size_t shot) -> Result<void> {
             beginDark(shots[shot].shot.exposure);
             return {};
         }});
    if (!taken) return taken.error();
    darksBefore_.reset();
    std::map<Microseconds, const proc::DarkFrame*> held;
    if (rig_.darkFramesHeld > 0) {
        for (const proc::DarkFrame& dark : bench_.darks) held[dark.exposure.requested] = &dark;
    }
    for (const auto& [exposure, sums] : darkSums_) {
        Result<proc::DarkFrame> dark = sums.sums.mean();
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

/// Pilots from before a break are not mixed with what the rig takes now.
bool PlannedRun::stale(std::size_t state) const {
    return pilots_[state].breaks != sequencer_.breaks();
}

std::vector<PlannedRun::Planned> PlannedRun::allCaptures() {
    std::vector<Planned> all;
    const auto list = [&](std::size_t state, KnownShot shot) {
        shot.joins = !all.empty() && all.back().state == state;
        shot.planStep = bench_.nextPlanStep++;
        all.push_back({.shot = shot, .state = state, .count = all.size() + 1});
    };
    for (std::size_t s = 0; s < states_.size(); ++s) {
        for (const proc::PlannedCapture& planned : plan_->states[s].captures)
            list(s, shotOf(states_[s], planned.shot, planned.frames));
    }
    for (const KnownShot& shot : pilotShots(states_.front())) list(states_.size(), shot);
    return all;
}

/// From the state at hand on, each behind its pilots where those are stale.
std::vector<PlannedRun::Planned> PlannedRun::left(const Taking& now) const {
    std::vector<Planned> list;
    std::size_t next = now.open;  // the first state that the list has nothing of
    for (const Planned& planned : now.all) {
        if (planned.state < now.open) continue;
        for (; next <= planned.state && next < states_.size(); ++next) {
            // Pilots alone are of one piece, whatever has come after them.
            const bool alone = next < planned.state;
            if (alone ? pilots_[next].breaks != kUnsound : !stale(next)) continue;
            for (const KnownShot& pilot : pilots_[next].shots) {
                list.push_back(
                    {.shot = pilot, .state = next, .count = planned.count - 1, .pilot = true});
            }
        }
        list.push_back(planned);
        if (planned.state < states_.size() && stale(planned.state)) list.back().shot.joins = true;
    }
    return list;
}

/// There were no dark frames of this run to hold them against as they came.
void PlannedRun::reviewPilots() {
    for (std::size_t state = 0; state < states_.size(); ++state) {
        if (!sequencer_.review(states_[state], pilots_[state].frames))
            pilots_[state].breaks = kUnsound;
    }
}

Result<Captured> PlannedRun::takeStates() {
    const Window window = pilots_.front().frames.front().window;
    Gathering gathering(bench_.rig,
                        bench_.attendance,
                        {.darks = darks_,
                         .binning = *binning_,
                         .glare = *glare_,
                         .corrections = bench_.corrections,
                         .profile = bench_.profile,
                         .clock = bench_.clock});
    expectLight(window, &freshDarks_);
    reviewPilots();
    Taking now{.gathering = gathering, .all = allCaptures()};
    do {
        now.stale = false;
        now.list = left(now);
        const Result<void> taken = takeList(now);
        if (!taken && !now.stale) return taken.error();
    } while (now.stale);
    bench_.attendance.captured();
    Result<Captured> captured = gathering.finish();
    if (!captured) return captured;
    const Stopwatch comparing(bench_.clock);
    Result<Repeat> repeat =
        alongside(bench_.rig, bench_.attendance.alive, [&] { return repeated(now.again); });
    if (!repeat) return repeat.error();
    captured->repeat = std::move(*repeat);
    captured->compute += compute_ + comparing.elapsed();
    captured->oddFrames = sequencer_.oddFrames();
    captured->darks = std::move(darks_);
    captured->freshDarks = std::move(freshDarks_);
    if (Result<void> on = bench_.step(stateName(states_.front()) + " again"); !on)
        return on.error();
    return captured;
}

Result<void> PlannedRun::takeList(Taking& now) {
    std::vector<KnownShot> shots;
    shots.reserve(now.list.size());
    for (const Planned& planned : now.list) shots.push_back(planned.shot);
    return sequencer_.take(
        shots,
        {.frame = [&](std::size_t shot,
                      Frame&& frame) { return add(now, now.list[shot], std::move(frame)); },
         .done = [&](std::size_t shot) -> Result<void> {
             const bool last =
                 shot + 1 == shots.size() || now.list[shot + 1].state != now.list[shot].state;
             if (last) tellOutlook(now.list[shot].count);
             return {};
         },
         .begin = [&](std::size_t shot) { return begin(now, now.list[shot]); }});
}

/// A state's bracket begins with this capture, perhaps not for the first time.
Result<void> PlannedRun::begin(Taking& now, const Planned& first) {
    if (Result<void> on = advanceTo(now, first.state); !on) return on;
    if (first.state == states_.size()) {
        now.again.clear();
        return {};
    }
    if (first.pilot) {
        pilots_[now.open].frames.clear();
        pilots_[now.open].breaks = sequencer_.breaks();
    } else if (stale(now.open)) {
        now.stale = true;
        return Error{ErrorKind::Internal, "the pilots are from before a break"};
    }
    return openState(now);
}

Result<void> PlannedRun::openState(Taking& now) {
    now.begun = true;
    now.gathering.begin(states_[now.open]);
    const std::vector<Frame>& pilots = pilots_[now.open].frames;
    for (const Frame& pilot : pilots)
        if (Result<void> added = now.gathering.add(pilot); !added) return added;
    sequencer_.watch().begin(pilots.empty() ? nullptr : &pilots.back());
    return {};
}

/// All states before `state` are complete.
Result<void> PlannedRun::advanceTo(Taking& now, std::size_t state) {
    while (now.open < state) {
        if (!now.begun) {
            if (Result<void> pilotsOnly = openState(now); !pilotsOnly) return pilotsOnly;
        }
        now.begun = false;
        if (Result<void> ended = now.gathering.end(); !ended) return ended;
        if (Result<void> on = bench_.step(stateName(states_[now.open])); !on) return on;
        // The first state's are compared with at the end.
        if (now.open > 0) pilots_[now.open].frames = {};
        ++now.open;
        sequencer_.watch().begin();  // it may hold the last of those
    }
    return {};
}

Result<void> PlannedRun::add(Taking& now, const Planned& planned, Frame&& frame) {
    if (planned.state == states_.size()) {
        now.again.push_back(std::move(frame));
        return {};
    }
    if (planned.pilot) pilots_[planned.state].frames.push_back(frame);
    return now.gathering.add(frame);
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
    Result<proc::CellSignal> first = signalOf(pilots_.front().frames);
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
    const auto work = [&] {
        return daemon::achieved(captured.signals, responsivities_, floor_, goal_.fMin);
    };
    const auto done = alongside(bench_.rig, bench_.attendance.alive, work);
    return done ? *done : work();
}

}  // namespace gonio::daemon
