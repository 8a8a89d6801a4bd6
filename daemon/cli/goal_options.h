#pragma once
// What a sample is captured for, as the command line says it: --effort, --target-uncertainty or
// --time-budget.

#include <string>

#include "daemon/capture_goal.h"

namespace gonio::daemon {

struct GoalOptions {
    std::string effort;             ///< empty: standard
    std::string targetUncertainty;  ///< "1%"
    std::string timeBudget;         ///< "5s"

    /// Usage error that names the option, and for more than one of them.
    [[nodiscard]] Result<CaptureGoal> parse() const;
};

/// "1%" -> 0.01; empty for what is no percentage above 0 and at most 100.
[[nodiscard]] std::optional<double> parsePercent(const std::string& text);

}  // namespace gonio::daemon
