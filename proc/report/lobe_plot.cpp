#include "proc/report/lobe_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "proc/core/number_text.h"
#include "proc/report/svg.h"

namespace gonio::proc {
namespace {

constexpr double kWidth = 720;
constexpr double kHeight = 420;
constexpr double kLeft = 64;
constexpr double kRight = 16;
constexpr double kTop = 44;
constexpr double kBottom = 46;
constexpr double kMostDecades = 6;

constexpr std::array<std::string_view, 6> kColours{
    "#c0392b", "#2a6fb0", "#2e8b57", "#8e44ad", "#d68910", "#16a085"};

/// The axes' ranges: whole decades of f, and the angles of the first curve.
struct Range {
    double lowDecade = 0;
    double highDecade = 1;
    double lowDeg = -75;
    double highDeg = 75;

    [[nodiscard]] Point at(double thetaDeg, double f) const {
        const double x = (thetaDeg - lowDeg) / (highDeg - lowDeg);
        const double y =
            std::clamp((std::log10(f) - lowDecade) / (highDecade - lowDecade), 0.0, 1.0);
        return {kLeft + x * (kWidth - kLeft - kRight),
                kHeight - kBottom - y * (kHeight - kTop - kBottom)};
    }
};

bool drawable(double f) { return std::isfinite(f) && f > 0; }

std::optional<Range> rangeOf(const std::vector<LobeCurve>& curves) {
    double low = HUGE_VAL;
    double high = 0;
    for (const LobeCurve& curve : curves) {
        for (const double f : curve.f) {
            if (!drawable(f)) continue;
            low = std::min(low, f);
            high = std::max(high, f);
        }
    }
    if (high <= 0 || curves.front().thetaDeg.empty()) return std::nullopt;
    Range range;
    range.highDecade = std::ceil(std::log10(high) - 1e-9);
    range.lowDecade = std::max(std::floor(std::log10(low) + 1e-9), range.highDecade - kMostDecades);
    range.lowDecade = std::min(range.lowDecade, range.highDecade - 1);
    range.lowDeg = curves.front().thetaDeg.front();
    range.highDeg = curves.front().thetaDeg.back();
    return range;
}

void drawAxes(Svg& svg, const Range& range) {
    for (double decade = range.lowDecade; decade <= range.highDecade; ++decade) {
        const double f = std::pow(10, decade);
        const Point left = range.at(range.lowDeg, f);
        svg.line(left, range.at(range.highDeg, f), {.colour = "#ddd"});
        svg.text({left.x - 6, left.y + 4}, shortest(f), Anchor::End);
    }
    const double floor = std::pow(10, range.lowDecade);
    const double roof = std::pow(10, range.highDecade);
    for (double degrees = -75; degrees <= 75; degrees += 15) {
        if (degrees < range.lowDeg || degrees > range.highDeg) continue;
        const Point foot = range.at(degrees, floor);
        svg.line(foot, range.at(degrees, roof), {.colour = "#eee"});
        svg.text({foot.x, foot.y + 16}, fixed(degrees, 0), Anchor::Middle);
    }
    svg.text(
        {kWidth / 2, kHeight - 8}, "theta_o in the plane of incidence, degrees", Anchor::Middle);
    svg.text({8, kTop - 8}, "f, 1/sr");
}

void drawCurve(Svg& svg, const Range& range, const LobeCurve& curve, const Stroke& stroke) {
    std::vector<Point> run;
    for (std::size_t i = 0; i < curve.f.size(); ++i) {
        if (drawable(curve.f[i])) {
            run.push_back(range.at(curve.thetaDeg[i], curve.f[i]));
            continue;
        }
        if (run.size() > 1) svg.polyline(run, stroke);
        run.clear();
    }
    if (run.size() > 1) svg.polyline(run, stroke);
}

}  // namespace

std::string lobePlot(const std::string& title, const std::vector<LobeCurve>& curves) {
    Svg svg(kWidth, kHeight);
    svg.title({kLeft, 20}, title);
    const auto range = curves.empty() ? std::nullopt : rangeOf(curves);
    if (!range) return svg.document();
    drawAxes(svg, *range);
    for (std::size_t i = 0; i < curves.size(); ++i) {
        Stroke stroke{.colour = "#aaa", .width = 6};
        if (i > 0) {
            stroke = {.colour = std::string(kColours[(i - 1) % kColours.size()]), .width = 1.5};
        }
        drawCurve(svg, *range, curves[i], stroke);
        const Point at{kLeft + 14, kTop + 14 + 16 * static_cast<double>(i)};
        svg.line({at.x, at.y}, {at.x + 24, at.y}, stroke);
        svg.text({at.x + 30, at.y + 4}, curves[i].name);
    }
    return svg.document();
}

}  // namespace gonio::proc
