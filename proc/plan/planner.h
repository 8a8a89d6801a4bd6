#pragma once
// From the pilots of all states to the captures of the whole run.
//
// The run: the pilot shots of every state, one frame each; dark frames; the captures of each state,
// from the highest reach down; the pilots of the first state again, which show what has changed
// meanwhile (no data of the sample); the last picture's transfer. While the host plans, the rig
// takes the dark frames of the pilots' exposures, which are needed in any case: only what they do
// not cover is waited for. Pilot frames are data, and their information is counted.
//
// What is chosen: for every state how many frames of which shot (cover.h), and for all states
// together which exposures are used and of how many dark frames each mean dark frame is made, as
// these are shared. All of it is the optimum where the plan says that it is proven: a stricter goal
// then never gets a cheaper plan. A budget is met by halving the interval of wanted uncertainties.
//
// Cells. One that saturates the shortest exposure at the dimmest level cannot be measured. One that
// lacks information even after maxFrames of the shot that tells it most is given no more than that.
// One with no light of its own cannot be measured to a relative uncertainty. These are counted and
// named; NaN are left out and counted. Cells with f < fMin are measured, but nothing is asked.

#include <vector>

#include "proc/plan/plan.h"
#include "proc/plan/systematic_floor.h"

namespace gonio::proc {

/// What is planned with; all borrowed.
struct PlanInput {
    const RigModel& rig;
    const std::vector<StatePilot>& states;
    const SystematicFloor& floor;
};

/// Usage error when rig or goal are out of their domain, there is no state, or the budget is less
/// than pilots and dark frames take: it says the least time.
[[nodiscard]] Result<Plan> planCaptures(const PlanInput& input, const PlanGoal& goal);

}  // namespace gonio::proc
