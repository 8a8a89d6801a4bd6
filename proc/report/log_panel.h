#pragma once
// A panel of a plot with two logarithmic axes.

#include <string_view>

#include "proc/report/colour_ramp.h"
#include "proc/report/svg.h"

namespace gonio::proc {

struct LogPanel {
    Point corner;  ///< upper left
    Point size;
    LogAxis x, y;

    /// Where a pair of values stands; clamped to the panel, 0 and below at its lower end.
    [[nodiscard]] Point at(const Point& values) const;
};

/// Lines at 1, 2 .. 9 of each decade, the decades' numbers along both axes, and the name of x
/// below.
void drawGrid(Svg& svg, const LogPanel& panel, std::string_view nameOfX);

}  // namespace gonio::proc
