#pragma once
// The uncertainty budgets of a sample's states, as proc/calibrate/budget_text.h reads them: as one
// table for people, and for machines.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "proc/calibrate/budget_text.h"

namespace gonio::daemon {

/// One line for each component: type, correlation class, size of the input, sensitivity, relative
/// standard uncertainty of f and degrees of freedom; medians over the states. What is not known
/// stays blank. Empty where there are no components.
[[nodiscard]] std::string budgetTable(const std::vector<proc::StateBudget>& budget);

/// A list of the states, as docs/json/info-gonio.json says: null for an effect on f that is not
/// known, and a size with its unit, sensitivity and degrees of freedom only where it is above 0.
[[nodiscard]] nlohmann::ordered_json budgetJson(const std::vector<proc::StateBudget>& budget);

}  // namespace gonio::daemon
