#include "daemon/capture_goal.h"

#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

constexpr Seconds kLongest = std::chrono::hours(1);

}  // namespace

std::string CaptureGoal::name() const {
    if (targetUncertainty) return "target " + shortest(100 * *targetUncertainty) + " %";
    if (timeBudget) return "budget " + shortest(timeBudget->count()) + " s";
    return std::string(gonio::name(effort));
}

proc::PlanGoal CaptureGoal::plan() const {
    if (targetUncertainty) return {.wanted = *targetUncertainty};
    if (timeBudget) return proc::PlanGoal::within(*timeBudget);
    return proc::PlanGoal::of(effort);
}

Result<void> CaptureGoal::check() const {
    if (targetUncertainty && timeBudget) {
        return Error{ErrorKind::Usage,
                     "a target uncertainty and a time budget cannot both be met; give one"};
    }
    if (targetUncertainty && !(*targetUncertainty > 0 && *targetUncertainty <= 1)) {
        return Error{ErrorKind::Usage,
                     "target uncertainty " + shortest(100 * *targetUncertainty) +
                         " %: wanted above 0 and at most 100 %"};
    }
    if (timeBudget && !(*timeBudget > Seconds(0) && *timeBudget <= kLongest)) {
        return Error{ErrorKind::Usage,
                     "time budget " + shortest(timeBudget->count()) +
                         " s: wanted above 0 and at most 3600 s"};
    }
    return {};
}

}  // namespace gonio::daemon
