#include "proc/table/cell_mean.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/core/median.h"

namespace gonio::proc {
namespace {

double atLeastRounding(const CellValue& one) {
    constexpr double kRounding = std::numeric_limits<float>::epsilon();
    constexpr double kSmallest = std::numeric_limits<float>::min();
    return std::max({one.uApart, kRounding * std::abs(one.value.value), kSmallest});
}

/// Sum to 1.
std::vector<double> weightsOf(std::span<const CellValue> values) {
    std::vector<double> weights, all;
    for (const CellValue& one : values) all.push_back(one.value.value);
    const double middle = median(all);
    double sum = 0;
    for (const CellValue& one : values) {
        const double u = atLeastRounding(one);
        const double away = std::abs(one.value.value - middle) / u;
        const double trust = values.size() > 2 && away > kOutlier ? kOutlier / away : 1;
        weights.push_back(trust / (u * u));
        sum += weights.back();
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

}  // namespace

bool canAverage(const CellSamples& cells, std::size_t cell) {
    return cells.present(cell) && std::isfinite(cells.f[cell]) &&
           std::isfinite(cells.uRandom[cell]) && std::isfinite(cells.uSystematic[cell]);
}

CellMean meanOf(std::span<const CellValue> values) {
    CellMean result{.mean = values.front().value, .group = {}, .away = {0}};
    if (values.size() == 1) return result;
    const std::vector<double> weights = weightsOf(values);
    Measured<double>& mean = result.mean;
    mean = {.value = 0, .uRandom = 0, .uSystematic = 0, .flags = {}};
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Measured<double>& one = values[i].value;
        mean.value += weights[i] * one.value;
        mean.uRandom = std::hypot(mean.uRandom, weights[i] * one.uRandom);
        mean.uSystematic += weights[i] * one.uSystematic;
        mean.flags = mean.flags | one.flags;
    }
    ConsistencySum::Group& group = result.group;
    group.freedom = values.size() - 1;
    result.away.clear();
    double squares = 0, known = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double off = values[i].value.value - mean.value;
        const double inU = off / atLeastRounding(values[i]);
        group.chiSquare += inU * inU;
        squares += off * off;
        known += 1 / (atLeastRounding(values[i]) * atLeastRounding(values[i]));
        result.away.push_back(inU / std::sqrt(std::max(1 - weights[i], 1e-9)));
        if (std::abs(result.away.back()) > kOutlier) ++group.outliers;
    }
    const auto freedom = static_cast<double>(group.freedom);
    group.relative = std::sqrt(squares / freedom) / std::abs(mean.value);
    if (group.outliers > 0) result.uAgreed = std::sqrt(group.chiSquare / freedom / known);
    return result;
}

double CellMean::uRandom() const { return std::max(mean.uRandom, uAgreed); }

double apartFrom(const Measured<double>& value, double shared) {
    const double common = shared * value.value;
    const double rest = value.uSystematic * value.uSystematic - common * common;
    return std::sqrt(value.uRandom * value.uRandom + std::max(0.0, rest));
}

}  // namespace gonio::proc
