#pragma once
// A sample, captured by a plan (proc/plan). First a few pilot frames of every state: they say how
// bright each cell is, and are data too. While the host plans, the rig takes the first dark frames
// of the pilots' exposures; then the rest of the dark frames and the captures of each state, added
// up as they arrive; at last the pilots of the first state again, which show what has changed
// meanwhile. The same placement always makes the same captures, however fast the host is.
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
    [[nodiscard]] std::vector<KnownShot> pilotShots(State state) const;
    [[nodiscard]] Result<void> takePilots();
    [[nodiscard]] Result<void> learn(std::size_t state);
    [[nodiscard]] Result<void> settle();
    [[nodiscard]] proc::PlanInput input() const;
    [[nodiscard]] bool holdsDarks(const Window& window) const;
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
    std::vector<std::vector<Frame>> pilots_;  ///< by state
    std::vector<proc::StatePilot> learnt_;    ///< what they say
    std::map<Microseconds, proc::DarkAverage> darkSums_;
    std::map<Microseconds, int> darksTaken_;
    proc::DarkLibrary darks_, freshDarks_;
    std::optional<proc::Binning> binning_;
    std::optional<proc::GlareFilter> glare_;
    std::optional<proc::Plan> plan_;
    Seconds compute_{0};

    std::optional<Alongside<void>> seeing_;  ///< binning and glare, in the making
    std::optional<Alongside<proc::StatePilot>> learning_;
};

}  // namespace gonio::daemon
