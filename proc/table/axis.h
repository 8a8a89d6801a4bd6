#pragma once
// Where a number lies on an ascending axis: between which two nodes, and how far. The coordinate is
// in the axis's own unit (degrees in files). Within 1e-9 of a node it is that node: angles that
// went through radians and back still find it.

#include <cstddef>
#include <optional>
#include <span>

namespace gonio::proc {

/// The value is (1 - t) node[low] + t node[high], t in [0, 1). At a node: low = high, t = 0.
struct AxisPlace {
    std::size_t low = 0, high = 0;
    double t = 0;

    [[nodiscard]] bool atNode() const { return low == high; }
};

/// (1 - t) low + t high; a node of no weight is not asked, so that its NaN cannot answer.
template <class ValueAt>
[[nodiscard]] double between(const AxisPlace& place, const ValueAt& valueAt) {
    const double low = valueAt(place.low);
    return place.t == 0 ? low : (1 - place.t) * low + place.t * valueAt(place.high);
}

/// Node by node, to a rounding.
[[nodiscard]] bool sameAxis(std::span<const double> a, std::span<const double> b, double rounding);

/// Empty outside [first, last], and on an empty axis.
[[nodiscard]] std::optional<AxisPlace> placeOn(std::span<const double> axis, double at);

/// Whether an end of an axis, at this distance from the end of its range, is the centre of a cell
/// that goes on to there: within three quarters of a step.
[[nodiscard]] constexpr bool endsInACell(double distance, double step) {
    return distance > 0 && distance < 0.75 * step;
}

/// Whether the last node of an axis and the first one of the next turn are neighbours: a gap of at
/// most 1.5 of the widest step.
[[nodiscard]] bool closesCircle(std::span<const double> axis);

/// The same on a circle of 360: a value between the last node and the first one of the next turn
/// lies between these two, where they are neighbours.
[[nodiscard]] std::optional<AxisPlace> placeOnCircle(std::span<const double> axis, double at);

}  // namespace gonio::proc
