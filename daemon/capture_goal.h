#pragma once
// What a sample is captured for, as a person says it: an effort, a wanted uncertainty, or a time.

#include <optional>
#include <string>

#include "proc/core/effort.h"
#include "proc/plan/goal.h"

namespace gonio::daemon {

/// At most one of the two is set; with neither the effort counts.
struct CaptureGoal {
    Effort effort = Effort::Standard;
    std::optional<double> targetUncertainty{};  ///< random, relative, k = 1, of each cell
    std::optional<Seconds> timeBudget{};        ///< on the rig, all told

    /// "standard", "target 0.5 %", "budget 5 s".
    [[nodiscard]] std::string name() const;
    [[nodiscard]] proc::PlanGoal plan() const;
    /// Usage error for both at once, a target that is not above 0 and at most 1 (100 %), and a
    /// budget that is not above 0 and at most an hour.
    [[nodiscard]] Result<void> check() const;
};

}  // namespace gonio::daemon
