#pragma once
// Densities on the unit square, bilinear between nodes that lie on its edges too, and the warp that
// makes them uniform: first y by the marginal, then x by the conditional distribution. A stack
// holds one density per parameter (the light's direction); between parameters the densities, each
// scaled to the integral 1, are blended linearly.
//
// In a row without any density x is left where it is. Sums are double, stored numbers float.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace gonio::proc {

/// On the unit square.
struct SquarePoint {
    double x = 0, y = 0;
};

/// Pictures of one size, one after another: slice > y > x (fastest).
struct GridStack {
    std::size_t width = 0, height = 0;
    std::vector<float> values;

    [[nodiscard]] std::size_t slices() const {
        const std::size_t each = width * height;
        return each == 0 ? 0 : values.size() / each;
    }
};

/// The slices that a parameter lies between, and their shares. A share of 0 is not looked at.
struct SliceBlend {
    std::array<std::size_t, 4> slice{};
    std::array<double, 4> share{1, 0, 0, 0};

    template <class Value>
    [[nodiscard]] double of(const Value& value) const {
        double sum = 0;
        for (std::size_t i = 0; i < slice.size(); ++i) {
            if (share[i] != 0) sum += share[i] * value(slice[i]);
        }
        return sum;
    }
};

/// Bilinear value of a slice; beyond the edge the edge's. At least 2 x 2 nodes.
[[nodiscard]] double bilinear(const GridStack& stack, std::size_t slice, const SquarePoint& at);

class Warp2d {
public:
    /// Nothing unless there are at least 2 x 2 nodes, values are finite and none is negative, and
    /// each slice has some density.
    [[nodiscard]] static std::optional<Warp2d> over(GridStack density);

    /// From uniform to the density.
    [[nodiscard]] SquarePoint sample(const SquarePoint& uniform, const SliceBlend& blend) const;
    /// The inverse of sample().
    [[nodiscard]] SquarePoint invert(const SquarePoint& at, const SliceBlend& blend) const;
    /// Of which the integral over the square is 1.
    [[nodiscard]] double density(const SquarePoint& at, const SliceBlend& blend) const;

private:
    explicit Warp2d(GridStack density);
    /// Scaled so that a slice's marginal ends at 1.
    [[nodiscard]] double valueAt(const SliceBlend& blend, std::size_t x, std::size_t y) const;
    [[nodiscard]] double conditionalAt(const SliceBlend& blend, std::size_t x, std::size_t y) const;
    [[nodiscard]] double marginalAt(const SliceBlend& blend, std::size_t y) const;
    [[nodiscard]] double rowTotal(const SliceBlend& blend, std::size_t y) const {
        return conditionalAt(blend, density_.width - 1, y);
    }

    GridStack density_;
    std::vector<float> conditional_;  ///< of a row up to x, like the density
    std::vector<float> marginal_;     ///< of the rows up to y: slice > y
    std::vector<double> scale_;       ///< of a slice
};

}  // namespace gonio::proc
