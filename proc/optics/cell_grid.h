#pragma once
// The fixed grid that every statistic runs over (DESIGN.md 3). Row k covers theta_o in [k, k + 1)
// degrees, k = 0..89, and has round(360 sin(k + 0.5 deg)) equal sectors that start at phi = 0:
// cells of about one square degree, numbered row by row from the normal. A cell's value is the
// solid-angle mean over it; its direction is its centre in (theta, phi).
//
// At the normal: row 0 has three sectors, phi wraps, and the normal itself lies in sector 0.
// At the horizon: theta = 90 deg and beyond lies in no cell.

#include <cstddef>
#include <optional>

#include "proc/core/direction.h"

namespace gonio::proc {

/// Where a cell is: row in [0, 90), sector in [0, sectors(row)).
struct CellPlace {
    int row = 0;
    int sector = 0;

    bool operator==(const CellPlace&) const = default;
};

/// Half-open in both angles: [thetaLow, thetaHigh) x [phiLow, phiHigh).
struct CellBounds {
    Radians thetaLow, thetaHigh;
    Radians phiLow, phiHigh;
};

class CellGrid {
public:
    static constexpr int kRows = 90;

    /// Number of cells over the hemisphere: 20 626.
    [[nodiscard]] static std::size_t count();
    /// row in [0, kRows).
    [[nodiscard]] static int sectors(int row);
    /// Number of the cell; the place must exist.
    [[nodiscard]] static std::size_t index(CellPlace place);
    /// cell in [0, count()).
    [[nodiscard]] static CellPlace place(std::size_t cell);

    [[nodiscard]] static Direction centre(std::size_t cell);
    [[nodiscard]] static CellBounds bounds(std::size_t cell);
    /// In steradian; the sum over all cells is 2 pi.
    [[nodiscard]] static double solidAngle(std::size_t cell);

    /// Empty at and below the horizon.
    [[nodiscard]] static std::optional<std::size_t> cellAt(const Direction& wo);
};

}  // namespace gonio::proc
