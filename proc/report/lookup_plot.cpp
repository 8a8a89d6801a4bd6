#include "proc/report/lookup_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

#include "proc/report/log_panel.h"

namespace gonio::proc {
namespace {

constexpr Point kSize{380, 260};
constexpr double kLeft = 66, kTop = 74, kGap = 70, kPitch = 350, kLegend = 46;
constexpr double kMark = 4;

/// How a method is drawn.
struct Ink {
    std::string_view method, colour;
};
constexpr std::array<Ink, 4> kInks{{{"baked", "#1f5fa8"},
                                    {"baked, no carrier", "#1e8449"},
                                    {"MERL nearest", "#d68910"},
                                    {"MERL trilinear", "#c0392b"}}};

std::string colourOf(std::string_view method) {
    for (const Ink& ink : kInks) {
        if (ink.method == method) return std::string(ink.colour);
    }
    return "#777";
}

/// Rows of one method and storage, by ascending bytes.
struct Curve {
    std::string method, storage;
    std::vector<const LookupRow*> rows;
};
using Curves = std::vector<Curve>;

/// What stands along a panel's x.
using Cost = double (*)(const LookupRow&);
double oneNs(const LookupRow& row) { return row.scalarNs; }
double arraysNs(const LookupRow& row) { return row.batchNs; }
double kibibytes(const LookupRow& row) { return static_cast<double>(row.bytes) / 1024; }

std::optional<Point> valuesOf(const LookupRow& row, Cost cost) {
    const Point values{cost(row), 100 * row.worst()};
    const bool drawable =
        std::isfinite(values.x) && values.x > 0 && std::isfinite(values.y) && values.y > 0;
    return drawable ? std::optional(values) : std::nullopt;
}

Curves curvesOf(const std::vector<LookupRow>& rows, const std::string& material) {
    Curves curves;
    for (const LookupRow& row : rows) {
        if (row.material != material) continue;
        auto own = std::find_if(curves.begin(), curves.end(), [&](const Curve& curve) {
            return curve.method == row.method && curve.storage == row.storage;
        });
        if (own == curves.end()) own = curves.insert(own, {row.method, row.storage, {}});
        own->rows.push_back(&row);
    }
    for (Curve& curve : curves) {
        std::stable_sort(curve.rows.begin(), curve.rows.end(), [](const auto* a, const auto* b) {
            return a->bytes < b->bytes;
        });
    }
    return curves;
}

std::vector<std::string> materialsOf(const std::vector<LookupRow>& rows) {
    std::vector<std::string> materials;
    for (const LookupRow& row : rows) {
        if (std::find(materials.begin(), materials.end(), row.material) == materials.end())
            materials.push_back(row.material);
    }
    return materials;
}

/// Axes that hold all rows of all materials, so that these compare.
LogPanel panelOf(const std::vector<LookupRow>& rows, const std::vector<Cost>& costs) {
    std::vector<double> x, y;
    for (const LookupRow& row : rows) {
        for (const Cost cost : costs) {
            const auto values = valuesOf(row, cost);
            if (!values) continue;
            x.push_back(values->x);
            y.push_back(values->y);
        }
    }
    const auto covering = [](const std::vector<double>& values) {
        const auto [least, most] = std::minmax_element(values.begin(), values.end());
        return values.empty() ? LogAxis{} : LogAxis::covering(*least, *most);
    };
    return {.corner = {}, .size = kSize, .x = covering(x), .y = covering(y)};
}

/// A regular polygon about a point: of four corners a square that stands on its side.
std::vector<Point> outline(Point at, std::string_view storage) {
    const int corners = storage == "float" ? 16 : storage == "half" ? 4 : 3;
    const double turn = corners == 4 ? 0.25 : 0;
    std::vector<Point> points;
    for (int k = 0; k <= corners; ++k) {
        const double angle = 2 * std::numbers::pi * (k + 2 * turn) / corners;
        points.push_back({at.x + kMark * std::sin(angle), at.y - kMark * std::cos(angle)});
    }
    return points;
}

void drawMark(Svg& svg, Point at, const LookupRow& row, const Stroke& ink) {
    const std::vector<Point> shape = outline(at, row.storage);
    if (row.onFront) svg.polygon(shape, ink.colour, 0.8);
    svg.polyline(shape, ink);
    if (row.knee) svg.circle(at, 2 * kMark, {.colour = "#222", .width = 1.2});
}

void drawCurve(Svg& svg, const LogPanel& panel, const Curve& curve, Cost cost, bool marked) {
    const Stroke ink{.colour = colourOf(curve.method), .width = 1, .dash = marked ? "" : "4 3"};
    std::vector<Point> line;
    for (const LookupRow* row : curve.rows) {
        const auto values = valuesOf(*row, cost);
        if (!values) continue;
        line.push_back(panel.at(*values));
        if (marked) drawMark(svg, line.back(), *row, ink);
    }
    if (line.size() > 1) svg.polyline(line, ink);
}

/// How many nodes the coarsest and the finest table have, and the knee's: of the curve that has it.
void drawResolutions(Svg& svg, const LogPanel& panel, const Curve& curve) {
    const auto knee = std::find_if(
        curve.rows.begin(), curve.rows.end(), [](const LookupRow* row) { return row->knee; });
    if (knee == curve.rows.end()) return;
    for (const LookupRow* row : curve.rows) {
        const auto values = valuesOf(*row, kibibytes);
        if (!values) continue;
        const Point at = panel.at(*values);
        if (row == *knee) {
            svg.text({at.x - 12, at.y + 4}, row->resolution, Anchor::End, 9);
        } else if (row == curve.rows.front() || row == curve.rows.back()) {
            svg.text({at.x + 8, at.y - 8}, row->resolution, Anchor::Start, 9);
        }
    }
}

void drawLegend(Svg& svg, Point at, const Curves& curves) {
    const double left = at.x;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const Curve& curve = curves[i];
        LookupRow mark;
        mark.storage = curve.storage;
        const Stroke ink{.colour = colourOf(curve.method), .width = 1, .dash = ""};
        drawMark(svg, {at.x, at.y - 3.5}, mark, ink);
        svg.text({at.x + 9, at.y}, curve.method + ", " + curve.storage, Anchor::Start, 10);
        at.x += 190;
        if (i % 4 == 3) at = {left, at.y + 16};
    }
}

}  // namespace

std::string lookupPlot(const std::vector<LookupRow>& rows) {
    const std::vector<std::string> materials = materialsOf(rows);
    const double height = kTop + static_cast<double>(materials.size()) * kPitch;
    Svg svg(kLeft + 2 * kSize.x + kGap + 24, height + (rows.empty() ? 0 : kLegend));
    svg.title({kLeft, 24}, "What look-ups err, take and weigh");
    if (rows.empty()) return svg.document();
    svg.text({kLeft, 42},
             "worst error, per cent; filled: on the front, ring: its knee; dashed: in arrays",
             Anchor::Start,
             10);
    LogPanel times = panelOf(rows, {oneNs, arraysNs});
    LogPanel sizes = panelOf(rows, {kibibytes});
    for (std::size_t m = 0; m < materials.size(); ++m) {
        const double top = kTop + static_cast<double>(m) * kPitch;
        times.corner = {kLeft, top};
        sizes.corner = {kLeft + kSize.x + kGap, top};
        svg.text({kLeft, top - 8}, materials[m]);
        drawGrid(svg, times, "ns an evaluation of R, G and B");
        drawGrid(svg, sizes, "KiB");
        for (const Curve& curve : curvesOf(rows, materials[m])) {
            drawCurve(svg, times, curve, oneNs, true);
            drawCurve(svg, times, curve, arraysNs, false);
            drawCurve(svg, sizes, curve, kibibytes, true);
            drawResolutions(svg, sizes, curve);
        }
    }
    drawLegend(svg, {kLeft + kMark, height}, curvesOf(rows, materials.front()));
    return svg.document();
}

}  // namespace gonio::proc
