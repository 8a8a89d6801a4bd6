#include "proc/optics/cell_blend.h"

#include <algorithm>
#include <cmath>

#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

constexpr double kAtCentre = 1e-9;  ///< of a cell's width

/// Where a coordinate in cells lies between two centres.
struct Between {
    int low;
    double fraction;  ///< 0: at the centre of `low`

    explicit Between(double t) : low(static_cast<int>(std::floor(t))), fraction(t - std::floor(t)) {
        if (fraction < kAtCentre || fraction > 1 - kAtCentre) {
            low = static_cast<int>(std::lround(t));
            fraction = 0;
        }
    }
};

}  // namespace

CellBlend::CellBlend(const Direction& wo) {
    const Between rows(wo.theta().degrees() - 0.5);
    const Radians phi = wo.phi();
    // Below the first row's centre the other side of the pole is the neighbour.
    const bool pole = rows.low < 0;
    const int last = CellGrid::kRows - 1;
    addRow(pole ? 0 : std::min(rows.low, last), pole ? phi + Radians(kPi) : phi, 1 - rows.fraction);
    addRow(std::min(rows.low + 1, last), phi, rows.fraction);
}

void CellBlend::addRow(int row, Radians phi, double weight) {
    const int sectors = CellGrid::sectors(row);
    const Between at(phi.value() / (2 * kPi) * sectors - 0.5);
    const auto cell = [&](int sector) {
        return CellGrid::index({row, ((sector % sectors) + sectors) % sectors});
    };
    add(cell(at.low), weight * (1 - at.fraction));
    add(cell(at.low + 1), weight * at.fraction);
}

void CellBlend::add(std::size_t cell, double weight) {
    if (weight <= 0) return;
    for (std::size_t i = 0; i < count_; ++i) {
        if (cells_[i].cell != cell) continue;
        cells_[i].weight += weight;
        return;
    }
    cells_[count_++] = {cell, weight};
}

}  // namespace gonio::proc
