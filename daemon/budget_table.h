#pragma once
// The uncertainty budgets of a sample's states as one table for people.

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace gonio::daemon {

/// One line for each component: type, correlation class, size of the input, sensitivity, relative
/// standard uncertainty of f and degrees of freedom; medians over the states. `budget` is what a
/// .gonio holds; what it does not have stays blank. Empty where there are no components.
[[nodiscard]] std::string budgetTable(const nlohmann::ordered_json& budget);

}  // namespace gonio::daemon
