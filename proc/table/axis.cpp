#include "proc/table/axis.h"

#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

constexpr double kSame = 1e-9;
constexpr double kTurn = 360;

double widestStep(std::span<const double> axis) {
    double widest = 0;
    for (std::size_t i = 1; i < axis.size(); ++i) widest = std::max(widest, axis[i] - axis[i - 1]);
    return widest;
}

}  // namespace

bool sameAxis(std::span<const double> a, std::span<const double> b, double rounding) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](double x, double y) {
        return std::abs(x - y) <= rounding;
    });
}

std::optional<AxisPlace> placeOn(std::span<const double> axis, double at) {
    const auto behind = std::upper_bound(axis.begin(), axis.end(), at);
    const auto high = static_cast<std::size_t>(behind - axis.begin());
    if (high > 0 && at - axis[high - 1] <= kSame) return AxisPlace{high - 1, high - 1, 0};
    if (high < axis.size() && axis[high] - at <= kSame) return AxisPlace{high, high, 0};
    if (high == 0 || high == axis.size()) return std::nullopt;
    const double low = axis[high - 1];
    return AxisPlace{high - 1, high, (at - low) / (axis[high] - low)};
}

bool closesCircle(std::span<const double> axis) {
    if (axis.empty()) return false;
    return axis.front() + kTurn - axis.back() <= 1.5 * widestStep(axis);
}

std::optional<AxisPlace> placeOnCircle(std::span<const double> axis, double at) {
    if (axis.empty() || !std::isfinite(at)) return std::nullopt;
    at -= kTurn * std::floor((at - axis.front()) / kTurn);  // into [first, first + 360)
    if (const auto inside = placeOn(axis, at)) return inside;
    const double next = axis.front() + kTurn;
    if (next - at <= kSame) return AxisPlace{0, 0, 0};
    if (!closesCircle(axis)) return std::nullopt;
    return AxisPlace{axis.size() - 1, 0, (at - axis.back()) / (next - axis.back())};
}

}  // namespace gonio::proc
