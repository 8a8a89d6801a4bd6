#pragma once
// How far a run has come. What was taken so far is compared with the plan: the time that the rest
// takes by the same model, and the uncertainties that the frames at hand achieve already.

#include "proc/plan/planner.h"

namespace gonio::proc {

/// What has been captured, in the order of the plan: pilots state by state, dark frames, then the
/// captures of the states. Counts beyond the plan's count as all.
struct CapturesTaken {
    std::size_t pilots = 0;    ///< pilot frames, of all states
    std::size_t darks = 0;     ///< dark captures
    std::size_t captures = 0;  ///< of the states, one after the other
};

struct Progress {
    Seconds spent{0};      ///< by the plan
    Seconds remaining{0};  ///< 0 when all is taken
    double share = 0;      ///< of the plan's time, 0..1
    /// Of the planned cells with the frames at hand, dark frames as planned; infinite where a cell
    /// has none yet.
    Prediction achieved;
};

/// `plan` was made of `input`.
[[nodiscard]] Progress progressOf(const PlanInput& input,
                                  const Plan& plan,
                                  const CapturesTaken& taken);

}  // namespace gonio::proc
