#include "proc/report/log_panel.h"

#include <cmath>
#include <string>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

/// Calls `line` with each value that has one, and whether it is a whole decade.
template <class Line>
void forEachLine(const LogAxis& axis, const Line& line) {
    for (int decade = axis.firstDecade; decade <= axis.lastDecade; ++decade) {
        const double here = std::pow(10.0, decade);
        for (int k = 2; k < 10 && decade < axis.lastDecade; ++k) line(k * here, false);
        line(here, true);
    }
}

Stroke strokeOf(bool decade) {
    return decade ? Stroke{.colour = "#ddd", .width = 0.7, .dash = ""}
                  : Stroke{.colour = "#f0f0f0", .width = 0.5, .dash = ""};
}

}  // namespace

Point LogPanel::at(const Point& values) const {
    return {corner.x + size.x * x.position(values.x),
            corner.y + size.y * (1 - y.position(values.y))};
}

void drawGrid(Svg& svg, const LogPanel& panel, std::string_view nameOfX) {
    const double left = panel.corner.x, right = left + panel.size.x;
    const double top = panel.corner.y, bottom = top + panel.size.y;
    forEachLine(panel.x, [&](double value, bool decade) {
        const double x = panel.at({value, 0}).x;
        svg.line({x, top}, {x, bottom}, strokeOf(decade));
        if (decade) svg.text({x, bottom + 15}, shortest(value), Anchor::Middle, 10);
    });
    forEachLine(panel.y, [&](double value, bool decade) {
        const double y = panel.at({0, value}).y;
        svg.line({left, y}, {right, y}, strokeOf(decade));
        if (decade) svg.text({left - 6, y + 4}, shortest(value), Anchor::End, 10);
    });
    svg.text({(left + right) / 2, bottom + 30}, nameOfX, Anchor::Middle, 10);
}

}  // namespace gonio::proc
