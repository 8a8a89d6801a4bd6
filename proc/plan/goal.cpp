#include "proc/plan/goal.h"

#include <cmath>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

Error refused(const std::string& what) {
    return {.kind = ErrorKind::Usage, .message = "plan: goal: " + what};
}

bool positive(double value) { return std::isfinite(value) && value > 0; }

}  // namespace

PlanGoal PlanGoal::of(Effort effort) {
    constexpr double kReferenceAim = 0.003;  // below its promise: the pilots' rates are estimates
    return {.wanted = effort == Effort::Reference ? kReferenceAim : promisedUncertainty(effort)};
}

PlanGoal PlanGoal::within(Seconds budget) { return {.budget = budget}; }

Result<void> PlanGoal::check() const {
    if (wanted.has_value() == budget.has_value())
        return refused("either a wanted uncertainty or a time budget, not both or none");
    if (wanted && !positive(*wanted))
        return refused("the wanted uncertainty must be above 0, saw " + shortest(*wanted));
    if (budget && !positive(budget->count()))
        return refused("the time budget must be above 0 s, saw " + shortest(budget->count()));
    if (!positive(fMin)) return refused("fMin must be above 0, saw " + shortest(fMin));
    if (!positive(floorShare))
        return refused("floorShare must be above 0, saw " + shortest(floorShare));
    return {};
}

double promisedUncertainty(Effort effort) {
    switch (effort) {
        case Effort::Draft: return 0.10;
        case Effort::Standard: return 0.01;
        case Effort::Reference: return 0.0045;
    }
    return 0.01;
}

}  // namespace gonio::proc
