#include "proc/report/hemisphere_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "proc/core/number_text.h"
#include "proc/core/parallel.h"
#include "proc/report/colour_ramp.h"
#include "proc/report/png.h"
#include "proc/report/svg.h"

namespace gonio::proc {
namespace {

constexpr int kRaster = 181;    // pixels across: one degree and one user unit each
constexpr int kShades = 64;     // colours told apart; runs of one colour are one stroke
constexpr int kNoData = 64;     // the shade behind them
constexpr int kOutside = -1;    // at or below the horizon
constexpr double kPanel = 200;  // user units between panel corners
constexpr double kLeft = 70, kTop = 76, kRight = 90, kBottom = 4;
constexpr std::string_view kGrey = "#d8d8d8";

using Panel = std::vector<LedBands>;  // kRaster x kRaster, NaN where unanswered

std::size_t pixel(int column, int row) { return static_cast<std::size_t>(row * kRaster + column); }

std::optional<Direction> directionAt(int column, int row) {
    const double x = column - (kRaster - 1) / 2.0;
    const double y = (kRaster - 1) / 2.0 - row;
    const double thetaDegrees = std::hypot(x, y);
    if (thetaDegrees >= 90) return std::nullopt;
    return Direction::fromSpherical(Radians::fromDegrees(thetaDegrees), Radians(std::atan2(y, x)));
}

Panel evaluate(const Scatterer& scatterer, Radians incidence) {
    Panel panel(std::size_t{kRaster} * kRaster,
                LedBands::all(std::numeric_limits<double>::quiet_NaN()));
    const Direction wi = Direction::fromSpherical(incidence, Radians(0));
    const auto fillRow = [&](int row) {
        for (int column = 0; column < kRaster; ++column) {
            if (const auto wo = directionAt(column, row))
                panel[pixel(column, row)] = scatterer.answer({.in = wi, .out = *wo}).f;
        }
    };
    parallelFor(kRaster, [&](IndexRange rows) {
        for (std::size_t row = rows.begin; row < rows.end; ++row) fillRow(static_cast<int>(row));
    });
    return panel;
}

LogAxis axisOf(const std::vector<Panel>& panels, std::span<const Band> bands) {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = 0;
    for (const Panel& panel : panels) {
        for (const LedBands& f : panel) {
            for (Band band : bands) {
                if (!std::isfinite(f[band]) || f[band] <= 0) continue;
                lowest = std::min(lowest, f[band]);
                highest = std::max(highest, f[band]);
            }
        }
    }
    if (highest == 0) return {};
    return LogAxis::covering(std::max(lowest, highest * 1e-6), highest);
}

int shadeOf(double f, const LogAxis& axis) {
    if (!std::isfinite(f)) return kNoData;
    return std::min(kShades - 1, static_cast<int>(axis.position(f) * kShades));
}

std::string colourOf(int shade) {
    return shade == kNoData ? std::string(kGrey) : rampColour((shade + 0.5) / kShades);
}

/// Of each pixel, row by row; kOutside beyond the disc.
std::vector<int> shadesOf(const Panel& panel, Band band, const LogAxis& axis) {
    std::vector<int> shades(panel.size(), kOutside);
    for (int row = 0; row < kRaster; ++row) {
        for (int column = 0; column < kRaster; ++column) {
            const std::size_t at = pixel(column, row);
            if (directionAt(column, row)) shades[at] = shadeOf(panel[at][band], axis);
        }
    }
    return shades;
}

/// Pixels of a row that have one shade.
struct Run {
    int row = 0, begin = 0, end = 0;
};

/// By shade.
std::array<std::vector<Run>, kShades + 1> runsOf(const std::vector<int>& shades) {
    std::array<std::vector<Run>, kShades + 1> runs;
    for (int row = 0; row < kRaster; ++row) {
        int begin = 0;
        int current = kOutside;
        for (int column = 0; column <= kRaster; ++column) {
            const int shade = column == kRaster ? kOutside : shades[pixel(column, row)];
            if (shade == current) continue;
            if (current != kOutside)
                runs[static_cast<std::size_t>(current)].push_back({row, begin, column});
            begin = column;
            current = shade;
        }
    }
    return runs;
}

/// The first run from the corner, each other one from the end of that before it: half as long as
/// all from the corner.
std::string pathOf(const std::vector<Run>& runs, Point corner) {
    std::string path;
    Run last;
    for (const Run& run : runs) {
        path += path.empty() ? "M" + fixed(corner.x + run.begin, 0) + " " +
                                   fixed(corner.y + run.row + 0.5, 1)
                             : "m" + std::to_string(run.begin - last.end) + " " +
                                   std::to_string(run.row - last.row);
        path += "h" + std::to_string(run.end - run.begin);
        last = run;
    }
    return path;
}

/// "#rrggbb".
Rgba opaque(const std::string& colour) {
    const auto byte = [&](std::size_t at) {
        return static_cast<std::uint8_t>(std::stoi(colour.substr(at, 2), nullptr, 16));
    };
    return {byte(1), byte(3), byte(5), 255};
}

/// What is outside has the last colour, which is none.
IndexedPicture pictureOf(const std::vector<int>& shades) {
    IndexedPicture picture{.width = kRaster, .height = kRaster, .pixels = {}, .colours = {}};
    for (int shade = 0; shade <= kNoData; ++shade)
        picture.colours.push_back(opaque(colourOf(shade)));
    picture.colours.push_back({0, 0, 0, 0});
    for (const int shade : shades)
        picture.pixels.push_back(
            static_cast<std::uint8_t>(shade == kOutside ? kNoData + 1 : shade));
    return picture;
}

void drawRuns(Svg& svg, Point corner, const std::vector<int>& shades) {
    const auto runs = runsOf(shades);
    for (int shade = 0; shade <= kNoData; ++shade) {
        const std::string path = pathOf(runs[static_cast<std::size_t>(shade)], corner);
        if (!path.empty()) svg.runs(path, colourOf(shade));
    }
}

void drawRaster(Svg& svg, Point corner, const std::vector<int>& shades, bool embedded) {
    if (!embedded) return drawRuns(svg, corner, shades);
    const auto png = encodePng(pictureOf(shades));
    if (!png) return drawRuns(svg, corner, shades);
    svg.image(corner, {kRaster, kRaster}, pngUri(*png));
}

/// Rings at 30, 60 and 90 degrees, and one about the light.
void drawRings(Svg& svg, Point corner, Radians incidence) {
    const Point centre{corner.x + kRaster / 2.0, corner.y + kRaster / 2.0};
    for (double ring : {30.0, 60.0})
        svg.circle(centre, ring, {.colour = "#ffffff", .width = 0.6, .dash = "2 3"});
    svg.circle(centre, kRaster / 2.0, {.colour = "#666", .width = 1, .dash = ""});
    if (incidence > 90_deg) return;
    const Point light{centre.x + incidence.degrees(), centre.y};
    svg.circle(light, 3.5, {.colour = "#ffffff", .width = 2.6, .dash = ""});
    svg.circle(light, 3.5, {.colour = "#d35400", .width = 1.4, .dash = ""});
}

void drawScale(Svg& svg, Point corner, double height, const LogAxis& axis) {
    // Each shade reaches up to the end and the next one lies over it: no seams.
    for (int shade = 0; shade < kShades; ++shade) {
        svg.rectangle(corner, {14, height * (kShades - shade) / kShades}, colourOf(shade));
    }
    for (int decade = axis.firstDecade; decade <= axis.lastDecade; ++decade) {
        const double y = corner.y + height * (1 - axis.position(std::pow(10.0, decade)));
        svg.line({corner.x + 14, y}, {corner.x + 18, y}, {});
        svg.text({corner.x + 21, y + 4}, "1e" + std::to_string(decade));
    }
}

void drawHeading(Svg& svg, const PlotRequest& request) {
    svg.title({kLeft, 24}, request.title);
    svg.text({kLeft, 41}, "dashed: theta_o 30, 60 deg; ring: the light", Anchor::Start, 10);
}

}  // namespace

std::string hemisphereMaps(const Scatterer& scatterer, const PlotRequest& request) {
    const std::span<const Band> bands = shownBands(scatterer);
    std::vector<Panel> panels;
    panels.reserve(request.incidences.size());
    for (Radians incidence : request.incidences) panels.push_back(evaluate(scatterer, incidence));
    const LogAxis axis = axisOf(panels, bands);

    const double width = static_cast<double>(bands.size()) * kPanel;
    const double height = static_cast<double>(panels.size()) * kPanel;
    Svg svg(kLeft + width + kRight, kTop + height + kBottom);
    drawHeading(svg, request);
    for (std::size_t row = 0; row < panels.size(); ++row) {
        const double top = kTop + static_cast<double>(row) * kPanel;
        svg.text({10, top + 86}, "light at", Anchor::Start, 10);
        svg.text({10, top + 101}, degreesLabel(request.incidences[row]));
        for (Band band : bands) {
            const Point corner{kLeft + static_cast<double>(index(band)) * kPanel, top};
            drawRaster(svg, corner, shadesOf(panels[row], band, axis), request.embedded);
            drawRings(svg, corner, request.incidences[row]);
        }
    }
    if (panels.empty()) return svg.document();
    for (Band band : bands) {
        const double middle = kLeft + static_cast<double>(index(band)) * kPanel + kRaster / 2.0;
        svg.text({middle, kTop - 12}, bandLabel(scatterer, band), Anchor::Middle, 12);
    }
    drawScale(svg, {kLeft + width + 4, kTop}, height - (kPanel - kRaster), axis);
    svg.text({kLeft + width, kTop - 12}, request.quantity);
    return svg.document();
}

}  // namespace gonio::proc
