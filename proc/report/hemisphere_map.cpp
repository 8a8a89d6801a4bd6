#include "proc/report/hemisphere_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "proc/core/number_text.h"
#include "proc/core/parallel.h"
#include "proc/report/colour_ramp.h"
#include "proc/report/svg.h"

namespace gonio::proc {
namespace {

constexpr int kRaster = 181;    // pixels across: one degree each
constexpr int kShades = 64;     // colours told apart; runs of one colour are one stroke
constexpr double kPanel = 200;  // user units between panel corners
constexpr double kLeft = 70, kTop = 60, kRight = 90, kBottom = 20;
constexpr std::string_view kNoData = "#d8d8d8";

using Raster = std::vector<std::optional<double>>;  // kRaster x kRaster, empty where unanswered

struct Panel {
    std::array<Raster, 3> bands;
};

std::optional<Direction> directionAt(int column, int row) {
    const double x = column - (kRaster - 1) / 2.0;
    const double y = (kRaster - 1) / 2.0 - row;
    const double thetaDegrees = std::hypot(x, y);
    if (thetaDegrees >= 90) return std::nullopt;
    return Direction::fromSpherical(Radians::fromDegrees(thetaDegrees), Radians(std::atan2(y, x)));
}

Panel evaluate(const Scatterer& scatterer, Radians incidence) {
    Panel panel;
    for (Raster& raster : panel.bands) raster.resize(std::size_t{kRaster} * kRaster);
    const Direction wi = Direction::fromSpherical(incidence, Radians(0));
    parallelFor(kRaster, [&](IndexRange rows) {
        for (std::size_t row = rows.begin; row < rows.end; ++row) {
            for (int column = 0; column < kRaster; ++column) {
                const auto wo = directionAt(column, static_cast<int>(row));
                if (!wo) continue;
                const Answer answer = scatterer.answer({.in = wi, .out = *wo});
                for (Band band : kBands) {
                    if (std::isnan(answer.f[band])) continue;
                    panel.bands[index(band)][row * kRaster + static_cast<std::size_t>(column)] =
                        answer.f[band];
                }
            }
        }
    });
    return panel;
}

LogAxis axisOf(const std::vector<Panel>& panels) {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = 0;
    for (const Panel& panel : panels) {
        for (const Raster& raster : panel.bands) {
            for (const auto& f : raster) {
                if (!f || *f <= 0) continue;
                lowest = std::min(lowest, *f);
                highest = std::max(highest, *f);
            }
        }
    }
    if (highest == 0) return {};
    return LogAxis::covering(std::max(lowest, highest * 1e-6), highest);
}

void drawRaster(Svg& svg, Point corner, const Raster& raster, const LogAxis& axis) {
    const double scale = (kPanel - 20) / kRaster;
    std::array<std::string, kShades + 1> paths;  // the last one: no data
    for (int row = 0; row < kRaster; ++row) {
        int start = 0;
        int current = -1;
        for (int column = 0; column <= kRaster; ++column) {
            int shade = -1;
            if (column < kRaster && directionAt(column, row)) {
                const auto& f = raster[static_cast<std::size_t>(row * kRaster + column)];
                shade = !f ? kShades
                        : *f <= 0
                            ? 0
                            : std::min(kShades - 1, static_cast<int>(axis.position(*f) * kShades));
            }
            if (shade == current) continue;
            if (current >= 0) {
                paths[static_cast<std::size_t>(current)] +=
                    "M" + fixed(corner.x + start * scale, 1) + " " +
                    fixed(corner.y + (row + 0.5) * scale, 1) + "h" +
                    fixed((column - start) * scale, 1);
            }
            start = column;
            current = shade;
        }
    }
    for (std::size_t shade = 0; shade < paths.size(); ++shade) {
        if (paths[shade].empty()) continue;
        const std::string colour = shade == kShades
                                       ? std::string(kNoData)
                                       : rampColour((static_cast<double>(shade) + 0.5) / kShades);
        svg.runs(paths[shade], colour);
    }
    const Point centre{corner.x + (kPanel - 20) / 2, corner.y + (kPanel - 20) / 2};
    for (double ring : {30.0, 60.0, 90.0}) {
        svg.circle(centre, ring * scale, {.colour = "#ffffff", .width = 0.5, .dash = "2 3"});
    }
    svg.circle(centre, 90.5 * scale, {.colour = "#666", .width = 0.8, .dash = ""});
}

void drawScale(Svg& svg, Point corner, double height, const LogAxis& axis) {
    for (int shade = 0; shade < kShades; ++shade) {
        const double step = height / kShades;
        svg.rectangle({corner.x, corner.y + height - (shade + 1) * step},
                      {14, step + 0.3},
                      rampColour((shade + 0.5) / kShades));
    }
    for (int decade = axis.firstDecade; decade <= axis.lastDecade; ++decade) {
        const double y = corner.y + height * (1 - axis.position(std::pow(10.0, decade)));
        svg.line({corner.x + 14, y}, {corner.x + 18, y}, {});
        svg.text({corner.x + 21, y + 4}, "1e" + std::to_string(decade));
    }
    svg.text({corner.x - 4, corner.y - 10}, "f, 1/sr");
}

}  // namespace

std::string hemisphereMaps(const Scatterer& scatterer, const PlotRequest& request) {
    std::vector<Panel> panels;
    for (Radians incidence : request.incidences) panels.push_back(evaluate(scatterer, incidence));
    const LogAxis axis = axisOf(panels);

    const double rows = static_cast<double>(panels.size());
    Svg svg(kLeft + 3 * kPanel + kRight, kTop + rows * kPanel + kBottom);
    svg.text({kLeft, 24}, request.title, Anchor::Start, 15);
    for (Band band : kBands) {
        svg.text({kLeft + (static_cast<double>(index(band)) + 0.45) * kPanel, 48},
                 std::string(1, "RGB"[index(band)]) + "  " + fixed(nanometres(band), 0) + " nm",
                 Anchor::Middle,
                 12);
    }
    for (std::size_t row = 0; row < panels.size(); ++row) {
        const double top = kTop + static_cast<double>(row) * kPanel;
        svg.text({10, top + kPanel / 2}, fixed(request.incidences[row].degrees(), 0) + " deg");
        for (Band band : kBands) {
            const double left = kLeft + static_cast<double>(index(band)) * kPanel;
            drawRaster(svg, {left, top}, panels[row].bands[index(band)], axis);
        }
    }
    drawScale(svg, {kLeft + 3 * kPanel + 4, kTop}, std::max(1.0, rows) * kPanel - 20, axis);
    return svg.document();
}

}  // namespace gonio::proc
