#pragma once
// Bilinear interpolation between the centres of CellGrid's cells: the two rows that enclose a
// direction, each linear in phi. Across the pole the neighbour is the other side's; below the last
// row's centre (89.5 degrees) that row alone counts.

#include <array>
#include <cstddef>
#include <span>

#include "proc/core/direction.h"

namespace gonio::proc {

struct CellWeight {
    std::size_t cell = 0;
    double weight = 0;
};

/// At most four cells; weights above 0, their sum 1. At a cell's centre (to 1e-9 of its width) that
/// cell alone.
class CellBlend {
public:
    /// wo above the horizon.
    explicit CellBlend(const Direction& wo);

    [[nodiscard]] std::span<const CellWeight> cells() const { return {cells_.data(), count_}; }
    [[nodiscard]] bool oneCell() const { return count_ == 1; }

private:
    void addRow(int row, Radians phi, double weight);
    void add(std::size_t cell, double weight);

    std::array<CellWeight, 4> cells_{};
    std::size_t count_ = 0;
};

}  // namespace gonio::proc
