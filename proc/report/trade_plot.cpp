#include "proc/report/trade_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "proc/core/number_text.h"
#include "proc/report/log_panel.h"

namespace gonio::proc {
namespace {

constexpr double kWidth = 360, kHeight = 250, kLeft = 66, kTop = 104, kGapX = 62, kGapY = 66;
constexpr std::array<std::string_view, 3> kColours{"#c0392b", "#7d6608", "#1f5fa8"};
constexpr std::string_view kFloorColour = "#777", kPublishedColour = "#1e8449";
constexpr double kMarkRadius = 3;
constexpr double kPercent = 100;

struct Axes {
    LogAxis seconds, percent;
};

/// One panel: seconds to the right, per cent upwards.
struct Panel {
    LogPanel area;

    [[nodiscard]] Point at(double seconds, double relative) const {
        return area.at({seconds, kPercent * relative});
    }
};

using Rows = std::vector<const TradeRow*>;

bool shown(const TradeRow& row) {
    const Prediction& predicted = row.predicted;
    return std::isfinite(predicted.total.worst) && predicted.random.worst > 0;
}

template <class Value>
std::vector<Value> distinct(const std::vector<TradeRow>& rows, Value TradeRow::*member) {
    std::vector<Value> values;
    for (const TradeRow& row : rows) {
        if (std::find(values.begin(), values.end(), row.*member) == values.end())
            values.push_back(row.*member);
    }
    return values;
}

/// The same for all panels, so that they compare.
Axes axesOf(const std::vector<TradeRow>& rows) {
    double soonest = kMiniDiffSeconds.count(), latest = kMiniDiffSeconds.count();
    double least = 0.01, most = 0.01;
    for (const TradeRow& row : rows) {
        if (!shown(row)) continue;
        soonest = std::min(soonest, row.seconds.total().count());
        latest = std::max(latest, row.seconds.total().count());
        least = std::min(least, row.predicted.random.worst);
        most = std::max(most, row.predicted.total.worst);
    }
    return {LogAxis::covering(soonest, latest),
            LogAxis::covering(kPercent * least, kPercent * most)};
}

void drawPublished(Svg& svg, const Panel& panel) {
    const double x = panel.at(kMiniDiffSeconds.count(), 1).x;
    const double top = panel.area.corner.y;
    svg.line({x, top},
             {x, top + kHeight},
             {.colour = std::string(kPublishedColour), .width = 1, .dash = ""});
    svg.text({x - 4, top + kHeight - 6}, "MiniDiff V2, 135 s", Anchor::End, 9);
}

void drawFloor(Svg& svg, const Panel& panel, const Rows& rows) {
    if (rows.empty()) return;
    const double floor = rows.front()->predicted.systematic.worst;
    const Point left = panel.at(0, floor);
    svg.line(left,
             {left.x + kWidth, left.y},
             {.colour = std::string(kFloorColour), .width = 1, .dash = "1 3"});
    svg.text({left.x + 4, left.y + 11},
             "systematic " + fixed(kPercent * floor, 2) + " %",
             Anchor::Start,
             9);
}

void drawLevels(Svg& svg, const Panel& panel, Rows rows, std::string_view colour) {
    std::sort(rows.begin(), rows.end(), [](const TradeRow* a, const TradeRow* b) {
        return a->seconds.total() < b->seconds.total();
    });
    std::vector<Point> total, random, bound;
    for (const TradeRow* row : rows) {
        const double seconds = row->seconds.total().count();
        total.push_back(panel.at(seconds, row->predicted.total.worst));
        random.push_back(panel.at(seconds, row->predicted.random.worst));
        if (row->cramerRao.count() > std::pow(10.0, panel.area.x.firstDecade))
            bound.push_back(panel.at(row->cramerRao.count(), row->predicted.random.worst));
    }
    const std::string ink(colour);
    svg.polyline(bound, {.colour = ink, .width = 1, .dash = "1 4"});
    svg.polyline(random, {.colour = ink, .width = 1.2, .dash = "6 4"});
    svg.polyline(total, {.colour = ink, .width = 1.6, .dash = ""});
    for (const Point& mark : total)
        svg.circle(mark, kMarkRadius, {.colour = ink, .width = 1.4, .dash = ""});
}

std::string_view colourOf(int levels) {
    return kColours[static_cast<std::size_t>(std::clamp(levels, 1, 3) - 1)];
}

void drawLegend(Svg& svg, const std::vector<int>& levels) {
    constexpr double kBaseline = 66, kSwatch = 24, kGap = 6, kLetter = 5.4;
    double x = kLeft;
    const auto entry = [&](const std::string& label, const Stroke& stroke) {
        svg.line({x, kBaseline - 3.5}, {x + kSwatch, kBaseline - 3.5}, stroke);
        svg.text({x + kSwatch + kGap, kBaseline}, label, Anchor::Start, 10);
        x += kSwatch + 3 * kGap + kLetter * static_cast<double>(label.size());
    };
    for (const int level : levels) {
        entry(std::to_string(level) + (level == 1 ? " LED level" : " LED levels"),
              {.colour = std::string(colourOf(level)), .width = 2, .dash = ""});
    }
    entry("total", {.colour = "#333", .width = 1.6, .dash = ""});
    entry("random", {.colour = "#333", .width = 1.2, .dash = "6 4"});
    entry("Cramer-Rao bound", {.colour = "#333", .width = 1, .dash = "1 4"});
}

}  // namespace

std::string tradePlot(const std::vector<TradeRow>& rows) {
    const auto rigs = distinct(rows, &TradeRow::rig);
    const auto materials = distinct(rows, &TradeRow::material);
    const auto levels = distinct(rows, &TradeRow::levels);
    const Axes axes = axesOf(rows);
    const auto columns = static_cast<double>(std::max<std::size_t>(rigs.size(), 2));
    Svg svg(kLeft + columns * (kWidth + kGapX) - kGapX + 24,
            kTop + static_cast<double>(materials.size()) * (kHeight + kGapY));
    svg.title({kLeft, 24}, "What a measurement takes, and how wrong it may be");
    svg.text(
        {kLeft, 44},
        "relative uncertainty of the worst cell (%, k = 1) over seconds; best plans, predicted",
        Anchor::Start,
        10);
    drawLegend(svg, levels);
    for (std::size_t row = 0; row < materials.size(); ++row) {
        for (std::size_t column = 0; column < rigs.size(); ++column) {
            const Point corner{kLeft + static_cast<double>(column) * (kWidth + kGapX),
                               kTop + static_cast<double>(row) * (kHeight + kGapY)};
            const Panel panel{{corner, {kWidth, kHeight}, axes.seconds, axes.percent}};
            drawGrid(svg, panel.area, "seconds on the rig");
            drawPublished(svg, panel);
            Rows all;
            for (const int level : levels) {
                Rows own;
                for (const TradeRow& r : rows) {
                    if (r.rig == rigs[column] && r.material == materials[row] &&
                        r.levels == level && shown(r))
                        own.push_back(&r);
                }
                drawLevels(svg, panel, own, colourOf(level));
                all.insert(all.end(), own.begin(), own.end());
            }
            drawFloor(svg, panel, all);
            svg.text({corner.x + kWidth / 2, corner.y - 8},
                     materials[row] + ", " + rigs[column],
                     Anchor::Middle);
        }
    }
    return svg.document();
}

}  // namespace gonio::proc
