#include "proc/report/slice_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "proc/report/colour_ramp.h"
#include "proc/report/svg.h"

namespace gonio::proc {
namespace {

constexpr double kWidth = 330, kHeight = 230, kLeft = 60, kTop = 92, kGapX = 70, kGapY = 50;
constexpr double kStepDegrees = 0.5;
constexpr std::string_view kLight = "#d35400";

struct Ink {
    std::string_view colour;
    std::string_view dash;  // so that curves which coincide all show
};
constexpr std::array<Ink, 3> kInks{{{"#c0392b", ""}, {"#1e8449", "8 6"}, {"#1f5fa8", "2 5"}}};
constexpr Ink kMonochromeInk{"#2c3e50", ""};

struct Sample {
    double degrees = 0;
    double f = 0;
    std::optional<double> u;  // combined, where known
};
using Piece = std::vector<Sample>;                // without a gap
using Slice = std::array<std::vector<Piece>, 3>;  // by band

/// One panel: where it stands, and its axes.
struct Panel {
    Point corner;
    LogAxis axis;

    [[nodiscard]] double x(double degrees) const {
        return corner.x + kWidth * (degrees + 90) / 180.0;
    }
    [[nodiscard]] double y(double f) const { return corner.y + kHeight * (1 - axis.position(f)); }
};

std::optional<double> finiteU(const Answer& answer, Band band) {
    const std::optional<double> u = answer.u(band);
    return u && std::isfinite(*u) ? u : std::nullopt;
}

Slice evaluate(const Scatterer& scatterer, Radians incidence) {
    Slice slice;
    const Direction wi = Direction::fromSpherical(incidence, Radians(0));
    std::array<bool, 3> open{false, false, false};
    for (double degrees = -89.5; degrees <= 89.5; degrees += kStepDegrees) {
        const Direction wo = Direction::fromSpherical(Radians::fromDegrees(std::abs(degrees)),
                                                      degrees < 0 ? Radians(0) : 180_deg);
        const Answer answer = scatterer.answer({.in = wi, .out = wo});
        for (Band band : shownBands(scatterer)) {
            const std::size_t b = index(band);
            const double f = answer.f[band];
            const bool shown = std::isfinite(f) && f > 0;
            if (shown && !open[b]) slice[b].emplace_back();
            if (shown) slice[b].back().push_back({degrees, f, finiteU(answer, band)});
            open[b] = shown;
        }
    }
    return slice;
}

LogAxis axisOf(const Slice& slice) {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = 0;
    for (const auto& pieces : slice) {
        for (const Piece& piece : pieces) {
            for (const Sample& s : piece) {
                lowest = std::min(lowest, s.f);
                highest = std::max(highest, s.f);
            }
        }
    }
    return highest > 0 ? LogAxis::covering(lowest, highest) : LogAxis{};
}

bool knowsUncertainty(const std::vector<Slice>& slices) {
    const auto known = [](const Sample& s) { return s.u.has_value(); };
    for (const Slice& slice : slices) {
        for (const auto& pieces : slice) {
            for (const Piece& piece : pieces) {
                if (std::any_of(piece.begin(), piece.end(), known)) return true;
            }
        }
    }
    return false;
}

void drawAxes(Svg& svg, const Panel& panel, Radians incidence) {
    const Stroke grid{.colour = "#ddd", .width = 0.7, .dash = ""};
    const Point corner = panel.corner;
    for (int decade = panel.axis.firstDecade; decade <= panel.axis.lastDecade; ++decade) {
        const double y = panel.y(std::pow(10.0, decade));
        svg.line({corner.x, y}, {corner.x + kWidth, y}, grid);
        svg.text({corner.x - 6, y + 4}, "1e" + std::to_string(decade), Anchor::End, 10);
    }
    for (int degrees = -90; degrees <= 90; degrees += 30) {
        const double x = panel.x(degrees);
        svg.line({x, corner.y}, {x, corner.y + kHeight}, grid);
        svg.text({x, corner.y + kHeight + 15}, std::to_string(degrees), Anchor::Middle, 10);
    }
    if (incidence > 90_deg) return;
    const double x = panel.x(-incidence.degrees());
    svg.line({x, corner.y},
             {x, corner.y + kHeight},
             {.colour = std::string(kLight), .width = 0.8, .dash = "2 3"});
}

/// f +- 2 u over samples that all know their u.
void drawBand(Svg& svg, const Panel& panel, std::span<const Sample> samples, const Ink& ink) {
    std::vector<Point> outline;
    for (const Sample& s : samples)
        outline.push_back({panel.x(s.degrees), panel.y(s.f + 2 * *s.u)});
    for (auto s = samples.rbegin(); s != samples.rend(); ++s)
        outline.push_back({panel.x(s->degrees), panel.y(s->f - 2 * *s->u)});
    svg.polygon(outline, ink.colour, 0.22);
}

void drawBands(Svg& svg, const Panel& panel, const Piece& piece, const Ink& ink) {
    const auto known = [](const Sample& s) { return s.u.has_value(); };
    for (auto from = piece.begin(); from != piece.end();) {
        from = std::find_if(from, piece.end(), known);
        const auto to = std::find_if_not(from, piece.end(), known);
        if (to - from > 1) drawBand(svg, panel, {from, to}, ink);
        from = to;
    }
}

void drawCurve(Svg& svg, const Panel& panel, const Piece& piece, const Ink& ink) {
    std::vector<Point> line;
    for (const Sample& s : piece) line.push_back({panel.x(s.degrees), panel.y(s.f)});
    if (line.size() == 1) {  // alone, as wide as its step
        const double half = kWidth * kStepDegrees / 360;
        line = {{line[0].x - half, line[0].y}, {line[0].x + half, line[0].y}};
    }
    svg.polyline(line,
                 {.colour = std::string(ink.colour), .width = 1.4, .dash = std::string(ink.dash)});
}

Ink inkOf(const Scatterer& scatterer, Band band) {
    return scatterer.bandCount() == BandCount::One ? kMonochromeInk : kInks[index(band)];
}

void drawLegend(Svg& svg, const Scatterer& scatterer, bool uncertain) {
    constexpr double kBaseline = 62, kSwatch = 22, kGap = 6, kLetter = 6.2;
    double x = kLeft;
    for (Band band : shownBands(scatterer)) {
        const Ink ink = inkOf(scatterer, band);
        svg.line({x, kBaseline - 3.5},
                 {x + kSwatch, kBaseline - 3.5},
                 {.colour = std::string(ink.colour), .width = 2, .dash = std::string(ink.dash)});
        const std::string label = bandLabel(scatterer, band);
        svg.text({x + kSwatch + kGap, kBaseline}, label, Anchor::Start, 10);
        x += kSwatch + 2 * kGap + kLetter * static_cast<double>(label.size());
    }
    if (uncertain) svg.text({x, kBaseline}, "shaded: +- 2 u", Anchor::Start, 10);
}

void drawPanel(
    Svg& svg, Point corner, const Scatterer& scatterer, const Slice& slice, Radians incidence) {
    const Panel panel{corner, axisOf(slice)};
    drawAxes(svg, panel, incidence);
    for (Band band : shownBands(scatterer)) {
        const Ink ink = inkOf(scatterer, band);
        for (const Piece& piece : slice[index(band)]) {
            drawBands(svg, panel, piece, ink);
            drawCurve(svg, panel, piece, ink);
        }
    }
    svg.text({corner.x + kWidth / 2, corner.y - 6},
             "light at " + degreesLabel(incidence) + " (dotted)",
             Anchor::Middle);
}

}  // namespace

std::string slicePlots(const Scatterer& scatterer, const PlotRequest& request) {
    std::vector<Slice> slices;
    for (Radians incidence : request.incidences) slices.push_back(evaluate(scatterer, incidence));

    const std::size_t columns = slices.size() < 2 ? 1 : 2;
    const auto rows = static_cast<double>((slices.size() + columns - 1) / columns);
    Svg svg(kLeft + static_cast<double>(columns) * (kWidth + kGapX) - kGapX + 20,
            kTop + rows * (kHeight + kGapY));
    svg.title({kLeft, 24}, request.title);
    svg.text({kLeft, 42}, "plane of incidence: f (1/sr) over theta_o (deg)", Anchor::Start, 10);
    drawLegend(svg, scatterer, knowsUncertainty(slices));
    for (std::size_t i = 0; i < slices.size(); ++i) {
        const Point corner{kLeft + static_cast<double>(i % columns) * (kWidth + kGapX),
                           kTop + static_cast<double>(i / columns) * (kHeight + kGapY)};
        drawPanel(svg, corner, scatterer, slices[i], request.incidences[i]);
    }
    return svg.document();
}

}  // namespace gonio::proc
