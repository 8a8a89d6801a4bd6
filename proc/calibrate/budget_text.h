#pragma once
// The uncertainty budgets of a sample's states as the text that it carries
// (SampleInfo::budgetJson): a JSON array of {"led", "band", "monte_carlo_cells", "components"}.

#include <cstddef>
#include <string_view>
#include <vector>

#include "proc/calibrate/budget.h"
#include "proc/core/bands.h"

namespace gonio::proc {

struct StateBudget {
    std::size_t led = 0;
    Band band = Band::R;
    std::size_t monteCarloCells = 0;  ///< whose uncertainty is that of Monte Carlo
    Budget components;                ///< medianRelative NaN where it is not known
};

/// What of it can be read, in its order; empty for text that is no such array. Total: a state
/// without a number or band, and a component that is no object, are left out.
[[nodiscard]] std::vector<StateBudget> readBudget(std::string_view text);

}  // namespace gonio::proc
