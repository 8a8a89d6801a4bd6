#pragma once
// The uncertainty budget of one state (GUM: JCGM 100): for each component how it was evaluated, how
// it correlates between cells, and its median share of f.

#include <string>
#include <string_view>
#include <vector>

namespace gonio::proc {

enum class Correlation {
    PerCell,   ///< independent from cell to cell
    PerState,  ///< one error for all cells of a state
    Common,    ///< one error for all cells of all states
};
[[nodiscard]] std::string_view name(Correlation correlation);

struct BudgetComponent {
    std::string name;
    char type = 'B';  ///< 'A': from repeats or statistics; 'B': from elsewhere
    Correlation correlation = Correlation::PerCell;
    double medianRelative = 0;  ///< k = 1, of f, over the cells present
};

using Budget = std::vector<BudgetComponent>;

}  // namespace gonio::proc
