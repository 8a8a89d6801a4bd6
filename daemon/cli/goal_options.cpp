#include "daemon/cli/goal_options.h"

#include <string_view>

#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

Error refused(const std::string& option, const std::string& text, const std::string& wanted) {
    return {ErrorKind::Usage, option + " '" + text + "': wanted " + wanted};
}

/// "5s" or "5".
std::optional<Seconds> parseSeconds(std::string_view text) {
    if (text.ends_with('s')) text.remove_suffix(1);
    const auto number = parseDouble(text);
    return number ? std::optional(Seconds(*number)) : std::nullopt;
}

}  // namespace

std::optional<double> parsePercent(const std::string& text) {
    if (!text.ends_with('%')) return std::nullopt;
    const auto number = parseDouble(std::string_view(text).substr(0, text.size() - 1));
    if (!number || !(*number > 0 && *number <= 100)) return std::nullopt;
    return *number / 100;
}

Result<CaptureGoal> GoalOptions::parse() const {
    const int given =
        int(!effort.empty()) + int(!targetUncertainty.empty()) + int(!timeBudget.empty());
    if (given > 1) {
        return Error{ErrorKind::Usage,
                     "--effort, --target-uncertainty and --time-budget exclude each other"};
    }
    CaptureGoal goal;
    if (!effort.empty()) {
        const Result<Effort> value = parseEffort(effort);
        if (!value) return value.error().in("--effort");
        goal.effort = *value;
    }
    if (!targetUncertainty.empty()) {
        goal.targetUncertainty = parsePercent(targetUncertainty);
        if (!goal.targetUncertainty)
            return refused("--target-uncertainty", targetUncertainty, "such as 1%");
    }
    if (!timeBudget.empty()) {
        goal.timeBudget = parseSeconds(timeBudget);
        if (!goal.timeBudget) return refused("--time-budget", timeBudget, "such as 5s");
    }
    if (Result<void> good = goal.check(); !good) return good.error();
    return goal;
}

}  // namespace gonio::daemon
