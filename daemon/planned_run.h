#pragma once
// A sample, captured by a plan (proc/plan). First a few pilot frames of every state: they say how
// bright each cell is, and are data too. While the host plans, the rig takes the first dark frames
// of the pilots' exposures; then the rest of the dark frames and the captures of each state, added
// up as they arrive; at last the pilots of the first state again, which show what has changed
// meanwhile. The same placement always makes the same captures, however fast the host is.
//
// Pilots and captures of a state are one bracket: where the rig has booted between them, or would
// not light, its pilots are taken again before its captures, by their own plan steps. So they are
// where the dark frames show that one of them is not what was asked for; the plan stays.
//
// Memory: the pilots, three pictures of 2 MB a state, until their state is captured; then its
// merged picture, 10 MB; and the sums of two states (merge_accumulator.h).

#include <map>
#include <optional>
#include <vector>

#include "daemon/capture_plan.h"
#include "daemon/gathering.h"
#include "daemon/measurement.h"
#include "proc/plan/planner.h"
#include "proc/plan/progress.h"

namespace gonio::daemon {

class PlannedRun {
public:
    /// All is borrowed.
    PlannedRun(const Bench& bench, const RigReferences& references, const proc::PlanGoal& goal);

    /// Takes the pilots, and plans. Usage error for a goal that cannot be planned for. The LEDs are
    /// lit after it: capture() or `bench.rig.darken()` follow.
    [[nodiscard]] Result<const proc::Plan*> plan();
    /// Takes what was planned. Dark afterwards, however it ends.
    [[nodiscard]] Result<Captured> capture();

    /// Steps of progress: of plan(), and of both once there is a plan.
    [[nodiscard]] int steps() const;
    /// What was achieved, as the plan predicts it.
    [[nodiscard]] proc::Prediction achieved(const Captured& captured) const;

private:
    /// A state's pilots: how they are taken, what came of them, and after how many breaks.
    struct Pilots {
        std::vector<KnownShot> shots;
        std::vector<Frame> frames;
        int breaks = 0;
    };
    /// A capture of a state.
    struct Planned {
        KnownShot shot;
        std::size_t state = 0;  ///< behind the last: the first one's pilots once more
        std::size_t count = 0;  ///< of the captures, when it is there
        bool pilot = false;     ///< that is taken again
    };
    /// The states while they are captured.
    struct Taking {
        Gathering& gathering;
        std::vector<Planned> all;
        std::vector<Planned> list{};  ///< what is left of them
        std::size_t open = 0;         ///< the state at hand
        bool begun = false;
        bool stale = false;  ///< its pilots are, and the list does not have them
        std::vector<Frame> again{};
    };
    /// Dark frames of one exposure, so far.
    struct DarkSums {
        proc::DarkAverage sums;
        int frames = 0;
    };
    [[nodiscard]] std::vector<KnownShot> pilotShots(State state) const;
    [[nodiscard]] std::vector<Planned> allCaptures();
    [[nodiscard]] std::vector<Planned> left(const Taking& now) const;
    [[nodiscard]] bool stale(std::size_t state) const;
    [[nodiscard]] Result<void> takeList(Taking& now);
    [[nodiscard]] Result<void> begin(Taking& now, const Planned& first);
    [[nodiscard]] Result<void> openState(Taking& now);
    [[nodiscard]] Result<void> advanceTo(Taking& now, std::size_t state);
    [[nodiscard]] Result<void> add(Taking& now, const Planned& planned, Frame&& frame);
    void expectLight(const Window& window, const proc::DarkLibrary* ofThisRun = nullptr);
    void reviewPilots();
    [[nodiscard]] Result<void> takePilots();
    [[nodiscard]] Result<void> learn(std::size_t state);
    [[nodiscard]] Result<void> settle();
    [[nodiscard]] proc::PlanInput input() const;
    [[nodiscard]] bool holdsDarks(const Window& window) const;
    void beginPilots(std::size_t state);
    void beginDark(Microseconds exposure);
    [[nodiscard]] Result<void> addDark(Microseconds exposure, const Frame& frame);
    [[nodiscard]] Result<void> takeDarks();
    [[nodiscard]] Result<Captured> takeStates();
    [[nodiscard]] Result<Repeat> repeated(const std::vector<Frame>& again) const;
    void tellOutlook(std::size_t capturesTaken) const;

    const Bench& bench_;
    const RigReferences& references_;
    const proc::PlanGoal goal_;
    Sequencer sequencer_;
    const std::vector<State> states_;
    const Responsivities responsivities_;
    const proc::SystematicFloor floor_;
    proc::RigModel rig_;
    std::vector<Pilots> pilots_;            ///< by state
    std::vector<proc::StatePilot> learnt_;  ///< what they say
    std::map<Microseconds, DarkSums> darkSums_;
    /// Those of the exposure at hand, as they were before it.
    std::optional<std::pair<Microseconds, DarkSums>> darksBefore_;
    proc::DarkLibrary darks_, freshDarks_;
    std::optional<proc::Binning> binning_;
    std::optional<proc::GlareFilter> glare_;
    std::optional<proc::Plan> plan_;
    Seconds compute_{0};

    std::optional<Alongside<void>> seeing_;  ///< binning and glare, in the making
    std::optional<Alongside<proc::StatePilot>> learning_;
};

}  // namespace gonio::daemon
