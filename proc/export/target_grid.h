#pragma once
// --grid: at which directions a table is asked for, where its format leaves it open.

#include <optional>
#include <string_view>
#include <vector>

#include "proc/core/result.h"

namespace gonio::proc {

struct TargetGrid {
    std::optional<std::vector<double>> incidenceDeg;  ///< ascending, [0, 90)
    std::optional<double> stepDeg;                    ///< of the directions of views, [0.1, 30]

    [[nodiscard]] bool asks() const { return incidenceDeg || stepDeg; }
    [[nodiscard]] double stepOr(double other) const { return stepDeg.value_or(other); }
};

/// "0,20,40", "0:10:80" (from, step, to), either with "/STEP" behind it, or "/STEP" alone. Usage
/// error for anything else, and for more than 181 incidences.
[[nodiscard]] Result<TargetGrid> parseTargetGrid(std::string_view text);

/// 0, step, 2 step, ... and `last` itself.
[[nodiscard]] std::vector<double> stepsTo(double last, double step);

}  // namespace gonio::proc
