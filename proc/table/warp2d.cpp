#include "proc/table/warp2d.h"

#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

/// The cell of a coordinate, and how far in it.
struct Cell {
    std::size_t at = 0;
    double t = 0;
};

Cell cellOf(double coordinate, std::size_t nodes) {
    const double place = std::clamp(coordinate, 0.0, 1.0) * static_cast<double>(nodes - 1);
    const std::size_t at = std::min(static_cast<std::size_t>(place), nodes - 2);
    return {at, place - static_cast<double>(at)};
}

double mix(double low, double high, double t) { return (1 - t) * low + t * high; }

/// Integral from 0 to t of what goes linearly from `low` to `high` over the unit.
double linearIntegral(double low, double high, double t) {
    return t * (low + t * (high - low) / 2);
}

/// The t of an integral: the form without a difference of near numbers.
double inverseIntegral(double low, double high, double integral) {
    const double root = std::sqrt(std::max(0.0, low * low + 2 * integral * (high - low)));
    return low + root == 0 ? 0 : std::clamp(2 * integral / (low + root), 0.0, 1.0);
}

/// Last of cells 0 .. count - 1 whose beginning is at most `sum`; `upTo` ascends.
template <class UpTo>
std::size_t cellBySum(std::size_t count, double sum, const UpTo& upTo) {
    std::size_t low = 0;
    std::size_t high = count;
    while (high - low > 1) {
        const std::size_t middle = (low + high) / 2;
        (upTo(middle) <= sum ? low : high) = middle;
    }
    return low;
}

}  // namespace

double bilinear(const GridStack& stack, std::size_t slice, const SquarePoint& at) {
    const Cell x = cellOf(at.x, stack.width);
    const Cell y = cellOf(at.y, stack.height);
    const float* node = stack.values.data() + (slice * stack.height + y.at) * stack.width + x.at;
    const float* above = node + stack.width;
    return mix(mix(static_cast<double>(node[0]), static_cast<double>(node[1]), x.t),
               mix(static_cast<double>(above[0]), static_cast<double>(above[1]), x.t),
               y.t);
}

std::optional<Warp2d> Warp2d::over(GridStack density) {
    if (density.width < 2 || density.height < 2 || density.slices() == 0) return std::nullopt;
    const bool sound = std::all_of(density.values.begin(), density.values.end(), [](float value) {
        return std::isfinite(value) && value >= 0;
    });
    if (!sound) return std::nullopt;
    Warp2d warp(std::move(density));
    const auto finite = [](auto number) { return std::isfinite(number); };
    if (!std::all_of(warp.scale_.begin(), warp.scale_.end(), finite) ||
        !std::all_of(warp.marginal_.begin(), warp.marginal_.end(), finite)) {
        return std::nullopt;
    }
    return warp;
}

Warp2d::Warp2d(GridStack density) : density_(std::move(density)) {
    const std::size_t width = density_.width;
    conditional_.reserve(density_.values.size());
    marginal_.reserve(density_.slices() * density_.height);
    for (std::size_t row = 0; row < density_.slices() * density_.height; ++row) {
        const float* values = density_.values.data() + row * width;
        double sum = 0;
        conditional_.push_back(0);
        for (std::size_t x = 1; x < width; ++x) {
            sum += (static_cast<double>(values[x - 1]) + static_cast<double>(values[x])) / 2;
            conditional_.push_back(static_cast<float>(sum));
        }
    }
    for (std::size_t slice = 0; slice < density_.slices(); ++slice) {
        const auto total = [&](std::size_t y) {
            return static_cast<double>(conditional_[(slice * density_.height + y + 1) * width - 1]);
        };
        double sum = 0;
        marginal_.push_back(0);
        for (std::size_t y = 1; y < density_.height; ++y) {
            sum += (total(y - 1) + total(y)) / 2;
            marginal_.push_back(static_cast<float>(sum));
        }
        scale_.push_back(1 / sum);
    }
}

double Warp2d::valueAt(const SliceBlend& blend, std::size_t x, std::size_t y) const {
    return blend.of([&](std::size_t s) {
        const float value = density_.values[(s * density_.height + y) * density_.width + x];
        return scale_[s] * static_cast<double>(value);
    });
}

double Warp2d::conditionalAt(const SliceBlend& blend, std::size_t x, std::size_t y) const {
    return blend.of([&](std::size_t s) {
        const float sum = conditional_[(s * density_.height + y) * density_.width + x];
        return scale_[s] * static_cast<double>(sum);
    });
}

double Warp2d::marginalAt(const SliceBlend& blend, std::size_t y) const {
    return blend.of([&](std::size_t s) {
        return scale_[s] * static_cast<double>(marginal_[s * density_.height + y]);
    });
}

SquarePoint Warp2d::sample(const SquarePoint& uniform, const SliceBlend& blend) const {
    const auto rows = [&](std::size_t y) { return marginalAt(blend, y); };
    const double ySum = std::clamp(uniform.y, 0.0, 1.0);
    const std::size_t y = cellBySum(density_.height - 1, ySum, rows);
    const double low = rowTotal(blend, y);
    const double high = rowTotal(blend, y + 1);
    const double t = inverseIntegral(low, high, ySum - rows(y));

    const auto columns = [&](std::size_t x) {
        return mix(conditionalAt(blend, x, y), conditionalAt(blend, x, y + 1), t);
    };
    const double xSum = std::clamp(uniform.x, 0.0, 1.0) * mix(low, high, t);
    const std::size_t x = cellBySum(density_.width - 1, xSum, columns);
    const double left = mix(valueAt(blend, x, y), valueAt(blend, x, y + 1), t);
    const double right = mix(valueAt(blend, x + 1, y), valueAt(blend, x + 1, y + 1), t);
    const double s = inverseIntegral(left, right, xSum - columns(x));
    return {.x = (static_cast<double>(x) + s) / static_cast<double>(density_.width - 1),
            .y = (static_cast<double>(y) + t) / static_cast<double>(density_.height - 1)};
}

SquarePoint Warp2d::invert(const SquarePoint& at, const SliceBlend& blend) const {
    const Cell x = cellOf(at.x, density_.width);
    const Cell y = cellOf(at.y, density_.height);
    const double left = mix(valueAt(blend, x.at, y.at), valueAt(blend, x.at, y.at + 1), y.t);
    const double right =
        mix(valueAt(blend, x.at + 1, y.at), valueAt(blend, x.at + 1, y.at + 1), y.t);
    const double low = rowTotal(blend, y.at);
    const double high = rowTotal(blend, y.at + 1);
    const double row = mix(low, high, y.t);
    const double upTo =
        mix(conditionalAt(blend, x.at, y.at), conditionalAt(blend, x.at, y.at + 1), y.t) +
        linearIntegral(left, right, x.t);
    return {.x = row > 0 ? upTo / row : at.x,
            .y = marginalAt(blend, y.at) + linearIntegral(low, high, y.t)};
}

double Warp2d::density(const SquarePoint& at, const SliceBlend& blend) const {
    const double cells =
        static_cast<double>(density_.width - 1) * static_cast<double>(density_.height - 1);
    return cells * blend.of([&](std::size_t s) { return scale_[s] * bilinear(density_, s, at); });
}

}  // namespace gonio::proc
