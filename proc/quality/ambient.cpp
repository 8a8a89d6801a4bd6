#include "proc/quality/ambient.h"

#include <cmath>
#include <vector>

#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

constexpr Radians kMargin = 3_deg;

/// Sum and number of some pixels' means, DN.
struct Sum {
    double dn = 0, pixels = 0;
    void add(double value) {
        dn += value;
        ++pixels;
    }
    [[nodiscard]] double mean() const { return dn / pixels; }
};

enum class Place {
    Inside,
    Margin,
    Outside
};

Place placeOf(const LensMap& lens, Radians field, const SensorPoint& at) {
    const std::optional<Direction> wo = lens.directionAt(at);
    if (!wo || wo->theta() > field + kMargin) return Place::Outside;
    return wo->theta() < field ? Place::Inside : Place::Margin;
}

/// The pixels of a dark frame, inside and, by column, outside.
struct Split {
    Sum inside;
    std::vector<Sum> outside;
    double insideColumns = 0;
};

Split split(const DarkFrame& dark, const LensMap& lens, Radians field) {
    const int width = dark.mean.width(), height = dark.mean.height();
    Split sums;
    sums.outside.resize(static_cast<std::size_t>(width));
    for (int x = 0; x < width; ++x) {
        bool any = false;
        for (int y = 0; y < height; ++y) {
            const double step = dark.window.binning;
            const Place place = placeOf(
                lens, field, {dark.window.x + (x + 0.5) * step, dark.window.y + (y + 0.5) * step});
            if (place == Place::Margin) continue;
            any = any || place == Place::Inside;
            Sum& sum =
                place == Place::Inside ? sums.inside : sums.outside[static_cast<std::size_t>(x)];
            sum.add(dark.mean.at(x, y));
        }
        sums.insideColumns += any ? 1 : 0;
    }
    return sums;
}

/// Where no light falls: the mean, and the scatter of one column's mean about it.
struct Darkness {
    double mean = 0, scatter = 0, columns = 0;
};

std::optional<Darkness> darknessOf(const std::vector<Sum>& columns) {
    Sum all;
    double used = 0;
    for (const Sum& column : columns) {
        all.dn += column.dn;
        all.pixels += column.pixels;
        used += column.pixels > 0 ? 1 : 0;
    }
    if (used < 2) return std::nullopt;
    double squares = 0;
    for (const Sum& column : columns) {
        if (column.pixels > 0) squares += std::pow(column.mean() - all.mean(), 2);
    }
    return Darkness{
        .mean = all.mean(), .scatter = std::sqrt(squares / (used - 1)), .columns = used};
}

}  // namespace

std::optional<AmbientLight> ambientLight(const DarkFrame& dark,
                                         const LensMap& lens,
                                         Radians field,
                                         const SensorNoise& noise) {
    const Split sums = split(dark, lens, field);
    const std::optional<Darkness> darkness = darknessOf(sums.outside);
    const double seconds = dark.exposure.seconds();
    if (!darkness || sums.inside.pixels == 0 || !(seconds > 0)) return std::nullopt;
    const double perDn = sums.inside.pixels * noise.electronsPerDn / seconds;
    const double u = darkness->scatter * std::sqrt(1 / darkness->columns + 1 / sums.insideColumns);
    return AmbientLight{.perSecond = perDn * (sums.inside.mean() - darkness->mean), .u = perDn * u};
}

std::optional<double> fieldSignal(const References& references, const Direction& wi, Band band) {
    const CellSignal& white = references.whiteSignal;
    const CellSignal& black = references.blackSignal;
    double sum = 0;
    for (std::size_t cell = 0; cell < white.size(); ++cell) {
        if (!white.present(cell) || !black.present(cell)) continue;
        const Direction wo = CellGrid::centre(cell);
        const Answer fw = references.white.answer({wi, wo}), fb = references.black.answer({wi, wo});
        if (!fw.present() || !fb.present() || !(fw.f[band] > fb.f[band])) continue;
        const double gain = (white.signal[cell] - black.signal[cell]) / (fw.f[band] - fb.f[band]);
        sum += gain * wo.z() * CellGrid::solidAngle(cell);
    }
    if (!(sum > 0)) return std::nullopt;
    return sum;
}

Verdict ambientVerdict(const std::optional<AmbientLight>& light,
                       const std::optional<double>& perF,
                       const QualityLimits& limits) {
    Verdict verdict{.name = "ambient",
                    .figure = {},
                    .evidence = "no dark frame shows the lens's field and what lies around it",
                    .next = {}};
    if (!light || !perF) return verdict;
    const double one = *perF * limits.ambientF;
    verdict.figure = Figure{.value = light->perSecond / one, .u = light->u / one, .unit = "1"};
    verdict.grade = graded(*verdict.figure, limits.ambient);
    if (light->perSecond < limits.sure * light->u) verdict.grade = Grade::Ok;
    verdict.evidence = "with all LEDs off the field shows " + amount(verdict.figure->value, "1") +
                       " of the light of f = 0.001";
    if (verdict.grade != Grade::Ok) {
        verdict.evidence = "light leaks in: " + verdict.evidence;
        verdict.next = "cover the sample, darken the room";
    }
    return verdict;
}

}  // namespace gonio::proc
