#pragma once
// The uncertainty budget of one state [Gum2008]: for each component how it was evaluated, how it
// correlates between cells, how large it is, and what that does to f: relative u(f) = sensitivity x
// size, medians over the cells present.

#include <optional>
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
    double size = 0;            ///< k = 1, of the input, in `unit`
    std::string unit = "relative";
    std::optional<double> freedom{};  ///< degrees of freedom; empty: so many that it is sure

    /// Relative change of f per unit of the input; 0 where the input is known exactly.
    [[nodiscard]] double sensitivity() const { return size > 0 ? medianRelative / size : 0; }
};

using Budget = std::vector<BudgetComponent>;

}  // namespace gonio::proc
