#include "proc/optics/cell_grid.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

namespace gonio::proc {
namespace {

constexpr double kTurn = 2 * kPi;

/// First cell of each row, and the count behind the last.
struct RowStarts {
    std::array<std::size_t, CellGrid::kRows + 1> first{};

    RowStarts() {
        for (std::size_t row = 0; row < CellGrid::kRows; ++row) {
            const double middle = (static_cast<double>(row) + 0.5) * (kPi / 180);
            first[row + 1] =
                first[row] + static_cast<std::size_t>(std::lround(360 * std::sin(middle)));
        }
    }
};

const std::array<std::size_t, CellGrid::kRows + 1>& starts() {
    static const RowStarts rows;
    return rows.first;
}

double sectorWidth(int row) { return kTurn / CellGrid::sectors(row); }

}  // namespace

std::size_t CellGrid::count() { return starts().back(); }

int CellGrid::sectors(int row) {
    assert(row >= 0 && row < kRows);
    const auto r = static_cast<std::size_t>(row);
    return static_cast<int>(starts()[r + 1] - starts()[r]);
}

std::size_t CellGrid::index(CellPlace place) {
    assert(place.sector >= 0 && place.sector < sectors(place.row));
    return starts()[static_cast<std::size_t>(place.row)] + static_cast<std::size_t>(place.sector);
}

CellPlace CellGrid::place(std::size_t cell) {
    assert(cell < count());
    const auto& first = starts();
    const auto behind = std::upper_bound(first.begin(), first.end(), cell);
    const auto row = behind - first.begin() - 1;
    return {static_cast<int>(row), static_cast<int>(cell - first[static_cast<std::size_t>(row)])};
}

/// Kept: each measurement asks for each of them many times.
Direction CellGrid::centre(std::size_t cell) {
    assert(cell < count());
    static const std::vector<Direction> centres = [] {
        std::vector<Direction> all;
        for (int row = 0; row < kRows; ++row) {
            for (int sector = 0; sector < sectors(row); ++sector) {
                all.push_back(Direction::fromSpherical(Radians::fromDegrees(row + 0.5),
                                                       Radians((sector + 0.5) * sectorWidth(row))));
            }
        }
        return all;
    }();
    return centres[cell];
}

CellBounds CellGrid::bounds(std::size_t cell) {
    const CellPlace at = place(cell);
    const double width = sectorWidth(at.row);
    return {Radians::fromDegrees(at.row),
            Radians::fromDegrees(at.row + 1),
            Radians(at.sector * width),
            Radians((at.sector + 1) * width)};
}

double CellGrid::solidAngle(std::size_t cell) {
    const int row = place(cell).row;
    // cos a - cos b, written so that it keeps its digits near the normal.
    const double middle = (row + 0.5) * (kPi / 180);
    return sectorWidth(row) * 2 * std::sin(middle) * std::sin(0.5 * (kPi / 180));
}

std::optional<std::size_t> CellGrid::cellAt(const Direction& wo) {
    const double degrees = wo.theta().degrees();
    if (!wo.aboveHorizon() || degrees >= kRows) return std::nullopt;
    const int row = static_cast<int>(degrees);
    const int sector = static_cast<int>(wo.phi().value() / sectorWidth(row));
    return index({row, std::min(sector, sectors(row) - 1)});
}

}  // namespace gonio::proc
