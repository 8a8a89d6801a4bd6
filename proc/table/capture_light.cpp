#include "proc/table/capture_light.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "proc/core/median.h"
#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

/// Of the cells. Where more contradict each other, what is common to the rest is no light: of a
/// sample that one rotation shows brighter on one side and darker on the other, half agree.
constexpr double kMostContradicting = 1.0 / 3;

/// In the median over the cells that all parts have: how much brighter each is than the first.
/// What a speck of dust does not reach, however much the light changed.
std::vector<double> roughScales(std::span<const CapturePart> parts) {
    std::vector<std::vector<double>> ratios(parts.size());
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        const PresentValues present = presentIn(parts, cell);
        if (present.values.size() < parts.size()) continue;
        const double first = present.values.front().value.value;
        if (!(first > 0)) continue;
        for (std::size_t i = 0; i < parts.size(); ++i)
            ratios[i].push_back(present.values[i].value.value / first);
    }
    std::vector<double> scales;
    for (std::vector<double>& one : ratios) {
        const double scale = one.empty() ? 1 : median(std::move(one));
        scales.push_back(scale > 0 ? scale : 1);
    }
    return scales;
}

/// sum(w f_i m) and sum(w m^2) over the cells that all parts have and agree on but for the light.
struct Sums {
    std::vector<double> product, square;
    std::size_t compared = 0, contradicting = 0;

    void add(const PresentValues& present) {
        std::vector<double> weights;
        double m = 0, all = 0;
        for (const CellValue& one : present.values) {
            weights.push_back(1 / std::pow(std::max(one.uApart, 1e-30), 2));
            m += weights.back() * one.value.value;
            all += weights.back();
        }
        m /= all;
        for (std::size_t i = 0; i < weights.size(); ++i) {
            product[i] += weights[i] * present.values[i].value.value * m;
            square[i] += weights[i] * m * m;
        }
    }

    [[nodiscard]] bool tellLight() const {
        const auto isPositive = [](double x) { return x > 0; };
        return static_cast<double>(contradicting) <=
                   kMostContradicting * static_cast<double>(compared) &&
               std::all_of(square.begin(), square.end(), isPositive) &&
               std::all_of(product.begin(), product.end(), isPositive);
    }
};

Sums sumsOf(std::span<const CapturePart> parts) {
    Sums sums{.product = std::vector<double>(parts.size()),
              .square = std::vector<double>(parts.size())};
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        const PresentValues present = presentIn(parts, cell);
        if (present.values.size() < parts.size()) continue;
        ++sums.compared;
        if (meanOf(withoutLight(present).values).group.outliers > 0) {
            ++sums.contradicting;  // dust is no change of the light
        } else {
            sums.add(present);
        }
    }
    return sums;
}

/// u(k_i - 1): the mean that k_i is held against holds k_i itself. `weights`: of each in it.
std::vector<double> apartFromMean(const std::vector<double>& u, std::span<const double> weights) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    double squares = 0;
    for (std::size_t i = 0; i < u.size(); ++i) squares += std::pow(weights[i] / sum * u[i], 2);
    std::vector<double> apart;
    for (std::size_t i = 0; i < u.size(); ++i) {
        const double own = weights[i] / sum;
        const double others = std::max(0.0, squares - std::pow(own * u[i], 2));
        apart.push_back(std::sqrt(std::pow((1 - own) * u[i], 2) + others));
    }
    return apart;
}

/// Chi-square is about the k's own mean, weighted by 1 / u_i^2: whatever m they are held against,
/// it has n - 1 degrees of freedom.
ConsistencySum::Group groupOf(const CaptureLight& light) {
    ConsistencySum::Group group{.freedom = light.scale.size() - 1};
    double mean = 0, sum = 0, squares = 0;
    for (std::size_t i = 0; i < light.scale.size(); ++i) {
        mean += light.scale[i] / (light.u[i] * light.u[i]);
        sum += 1 / (light.u[i] * light.u[i]);
        squares += std::pow(light.scale[i] - 1, 2);
    }
    mean /= sum;
    for (std::size_t i = 0; i < light.scale.size(); ++i) {
        group.chiSquare += std::pow((light.scale[i] - mean) / light.u[i], 2);
        if (std::abs(light.away[i]) > kOutlier) ++group.outliers;
    }
    group.relative = std::sqrt(squares / static_cast<double>(group.freedom));
    return group;
}

}  // namespace

PresentValues presentIn(std::span<const CapturePart> parts, std::size_t cell) {
    PresentValues present;
    for (const CapturePart& part : parts) {
        if (!canAverage(*part.cells, cell)) continue;
        const Measured<double> value = part.cells->at(cell);
        present.values.push_back({value, apartFrom(value, part.shared)});
        present.captures.push_back(part.capture);
        present.scales.push_back(part.scale);
    }
    return present;
}

PresentValues withoutLight(PresentValues present) {
    for (std::size_t i = 0; i < present.values.size(); ++i) {
        const double scale = present.scales[i];
        present.values[i].value.value /= scale;
        present.values[i].value.uRandom /= scale;
        present.values[i].uApart /= scale;
    }
    return present;
}

CaptureLight lightOf(std::vector<CapturePart> parts) {
    CaptureLight light;
    if (parts.size() < 2) return light;
    const std::vector<double> rough = roughScales(parts);
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i].scale = rough[i];
    const Sums sums = sumsOf(parts);
    if (!sums.tellLight()) return light;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        light.scale.push_back(sums.product[i] / sums.square[i]);
        light.u.push_back(std::hypot(1 / std::sqrt(sums.square[i]), parts[i].light));
    }
    const std::vector<double> apart = apartFromMean(light.u, sums.square);
    for (std::size_t i = 0; i < parts.size(); ++i)
        light.away.push_back((light.scale[i] - 1) / apart[i]);
    light.group = groupOf(light);
    return light;
}

}  // namespace gonio::proc
