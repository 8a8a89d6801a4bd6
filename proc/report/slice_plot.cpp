#include "proc/report/slice_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "proc/core/number_text.h"
#include "proc/report/colour_ramp.h"
#include "proc/report/svg.h"

namespace gonio::proc {
namespace {

constexpr double kWidth = 330, kHeight = 230, kLeft = 55, kTop = 60, kGapX = 40, kGapY = 55;
constexpr double kStepDegrees = 0.5;
constexpr std::array<std::string_view, 3> kBandColours{"#c0392b", "#1e8449", "#1f5fa8"};

struct Sample {
    double degrees = 0;
    double f = 0;
    double u = 0;
};
using Curve = std::vector<std::vector<Sample>>;  // unbroken pieces

struct Slice {
    std::array<Curve, 3> bands;
};

double combined(const Answer& answer, Band band) {
    const double random = answer.uRandom ? (*answer.uRandom)[band] : 0;
    const double systematic = answer.uSystematic ? (*answer.uSystematic)[band] : 0;
    return std::hypot(random, systematic);
}

Slice evaluate(const Scatterer& scatterer, Radians incidence) {
    Slice slice;
    const Direction wi = Direction::fromSpherical(incidence, Radians(0));
    std::array<bool, 3> open{false, false, false};
    for (double degrees = -89.5; degrees <= 89.5; degrees += kStepDegrees) {
        const Direction wo = Direction::fromSpherical(Radians::fromDegrees(std::abs(degrees)),
                                                      degrees < 0 ? Radians(0) : 180_deg);
        const Answer answer = scatterer.answer({.in = wi, .out = wo});
        for (Band band : kBands) {
            const std::size_t b = index(band);
            const double f = answer.f[band];
            if (!(f > 0)) {
                open[b] = false;
                continue;
            }
            if (!open[b]) slice.bands[b].emplace_back();
            open[b] = true;
            slice.bands[b].back().push_back({degrees, f, combined(answer, band)});
        }
    }
    return slice;
}

LogAxis axisOf(const Slice& slice) {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = 0;
    for (const Curve& curve : slice.bands) {
        for (const auto& piece : curve) {
            for (const Sample& s : piece) {
                lowest = std::min(lowest, s.f);
                highest = std::max(highest, s.f);
            }
        }
    }
    return highest > 0 ? LogAxis::covering(lowest, highest) : LogAxis{};
}

void drawAxes(Svg& svg, Point corner, const LogAxis& axis) {
    const Stroke grid{.colour = "#ddd", .width = 0.7, .dash = ""};
    for (int decade = axis.firstDecade; decade <= axis.lastDecade; ++decade) {
        const double y = corner.y + kHeight * (1 - axis.position(std::pow(10.0, decade)));
        svg.line({corner.x, y}, {corner.x + kWidth, y}, grid);
        svg.text({corner.x - 5, y + 4}, "1e" + std::to_string(decade), Anchor::End, 10);
    }
    for (int degrees = -90; degrees <= 90; degrees += 30) {
        const double x = corner.x + kWidth * (degrees + 90) / 180.0;
        svg.line({x, corner.y}, {x, corner.y + kHeight}, grid);
        svg.text({x, corner.y + kHeight + 14}, std::to_string(degrees), Anchor::Middle, 10);
    }
}

void drawCurve(
    Svg& svg, Point corner, const LogAxis& axis, const Curve& curve, std::string_view ink) {
    const auto place = [&](double degrees, double f) {
        const double floor = std::pow(10.0, axis.firstDecade);
        return Point{corner.x + kWidth * (degrees + 90) / 180.0,
                     corner.y + kHeight * (1 - axis.position(std::max(f, floor)))};
    };
    for (const auto& piece : curve) {
        std::vector<Point> line;
        std::vector<Point> band;
        for (const Sample& s : piece) {
            line.push_back(place(s.degrees, s.f));
            band.push_back(place(s.degrees, s.f + 2 * s.u));
        }
        for (auto s = piece.rbegin(); s != piece.rend(); ++s) {
            band.push_back(place(s->degrees, s->f - 2 * s->u));
        }
        svg.polygon(band, ink, 0.25);
        svg.polyline(line, {.colour = std::string(ink), .width = 1.2, .dash = ""});
    }
}

}  // namespace

std::string slicePlots(const Scatterer& scatterer, const PlotRequest& request) {
    const auto rows = static_cast<double>((request.incidences.size() + 1) / 2);
    Svg svg(kLeft + 2 * (kWidth + kGapX) + 20, kTop + rows * (kHeight + kGapY));
    svg.text({kLeft, 24}, request.title, Anchor::Start, 15);
    svg.text({kLeft, 42},
             "f (1/sr) in the plane of incidence against theta_o (degrees; light on the left); "
             "shaded: +- 2 u",
             Anchor::Start,
             10);
    for (std::size_t i = 0; i < request.incidences.size(); ++i) {
        const Point corner{kLeft + static_cast<double>(i % 2) * (kWidth + kGapX),
                           kTop + static_cast<double>(i / 2) * (kHeight + kGapY)};
        const Slice slice = evaluate(scatterer, request.incidences[i]);
        const LogAxis axis = axisOf(slice);
        drawAxes(svg, corner, axis);
        for (Band band : kBands) {
            drawCurve(svg, corner, axis, slice.bands[index(band)], kBandColours[index(band)]);
        }
        svg.text({corner.x + 6, corner.y + 14},
                 "theta_i " + fixed(request.incidences[i].degrees(), 0) + " deg");
    }
    return svg.document();
}

}  // namespace gonio::proc
