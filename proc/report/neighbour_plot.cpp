#include "proc/report/neighbour_plot.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "proc/core/number_text.h"
#include "proc/report/log_panel.h"

namespace gonio::proc {
namespace {

constexpr Point kSize{380, 300};
constexpr double kLeft = 66, kTop = 70, kGap = 70, kBottom = 90;

struct Curve {
    std::string name;
    std::string_view colour;
    double exponent;
    std::vector<Point> points;  ///< samples, and seconds or bytes
};

template <class Value>
Curve curveOf(const std::vector<NeighbourCost>& rows,
              std::string name,
              std::string_view colour,
              const Value& value) {
    Curve curve{std::move(name), colour, growthOf(rows, value), {}};
    for (const NeighbourCost& row : rows) {
        const double y = value(row);
        if (y > 0) curve.points.push_back({static_cast<double>(row.samples), y});
    }
    return curve;
}

std::vector<Curve> timesOf(const std::vector<NeighbourCost>& rows) {
    return {
        curveOf(rows, "building", "#777", [](const NeighbourCost& r) { return r.build.count(); }),
        curveOf(rows,
                "query, walk over all",
                "#c0392b",
                [](const NeighbourCost& r) { return r.bruteForce.count(); }),
        curveOf(rows, "query, tree", "#1f5fa8", [](const NeighbourCost& r) {
            return r.query.count();
        })};
}

std::vector<Curve> bytesOf(const std::vector<NeighbourCost>& rows) {
    return {curveOf(rows,
                    "samples",
                    "#777",
                    [](const NeighbourCost& r) { return static_cast<double>(r.sampleBytes); }),
            curveOf(rows, "tree", "#1f5fa8", [](const NeighbourCost& r) {
                return static_cast<double>(r.treeBytes);
            })};
}

/// Of one coordinate of all curves.
LogAxis axisOf(const std::vector<Curve>& curves, double Point::*coordinate) {
    std::vector<double> values;
    for (const Curve& curve : curves) {
        for (const Point& point : curve.points) values.push_back(point.*coordinate);
    }
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return values.empty() ? LogAxis{} : LogAxis::covering(*least, *most);
}

/// Names below the panel, each with its power.
void drawLegend(Svg& svg, const LogPanel& panel, const std::vector<Curve>& curves) {
    double y = panel.corner.y + panel.size.y + 46;
    for (const Curve& curve : curves) {
        svg.line({panel.corner.x, y - 3.5},
                 {panel.corner.x + 24, y - 3.5},
                 {.colour = std::string(curve.colour), .width = 2, .dash = ""});
        const std::string power =
            std::isfinite(curve.exponent) ? ": n^" + fixed(curve.exponent, 2) : "";
        svg.text({panel.corner.x + 30, y}, curve.name + power, Anchor::Start, 10);
        y += 14;
    }
}

void drawPanel(Svg& svg, Point corner, std::string_view what, const std::vector<Curve>& curves) {
    const LogPanel panel{corner, kSize, axisOf(curves, &Point::x), axisOf(curves, &Point::y)};
    drawGrid(svg, panel, "samples");
    svg.text({corner.x + kSize.x / 2, corner.y - 8}, what, Anchor::Middle);
    for (const Curve& curve : curves) {
        std::vector<Point> line;
        for (const Point& point : curve.points) line.push_back(panel.at(point));
        const Stroke ink{.colour = std::string(curve.colour), .width = 1.6, .dash = ""};
        svg.polyline(line, ink);
        for (const Point& mark : line) svg.circle(mark, 3, ink);
    }
    drawLegend(svg, panel, curves);
}

}  // namespace

std::string neighbourPlot(const std::vector<NeighbourCost>& rows) {
    Svg svg(kLeft + 2 * kSize.x + kGap + 24, kTop + kSize.y + kBottom);
    svg.title({kLeft, 24}, "What nearest neighbours cost");
    if (rows.empty()) return svg.document();
    drawPanel(svg, {kLeft, kTop}, "seconds", timesOf(rows));
    drawPanel(svg, {kLeft + kSize.x + kGap, kTop}, "bytes", bytesOf(rows));
    return svg.document();
}

}  // namespace gonio::proc
