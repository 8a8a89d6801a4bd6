#include "proc/optics/cell_grid.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gonio::proc {
namespace {

TEST(CellGrid, HasTheCellsOfTheContract) {
    std::size_t sum = 0;
    for (int row = 0; row < CellGrid::kRows; ++row) {
        EXPECT_EQ(CellGrid::sectors(row), std::lround(360 * std::sin((row + 0.5) * kPi / 180)));
        sum += static_cast<std::size_t>(CellGrid::sectors(row));
    }
    EXPECT_EQ(CellGrid::count(), sum);
    EXPECT_EQ(CellGrid::sectors(0), 3);
    EXPECT_EQ(CellGrid::sectors(89), 360);
}

TEST(CellGrid, EachCellHoldsItsCentreAndKnowsItsPlace) {
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        ASSERT_EQ(CellGrid::index(CellGrid::place(cell)), cell);
        ASSERT_EQ(CellGrid::cellAt(CellGrid::centre(cell)), cell);
        const CellBounds bounds = CellGrid::bounds(cell);
        ASSERT_LT(bounds.thetaLow, CellGrid::centre(cell).theta());
        ASSERT_LT(CellGrid::centre(cell).theta(), bounds.thetaHigh);
    }
}

TEST(CellGrid, SolidAnglesFillTheHemisphere) {
    double sum = 0;
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        const CellBounds b = CellGrid::bounds(cell);
        const double exact = (cos(b.thetaLow) - cos(b.thetaHigh)) * (b.phiHigh - b.phiLow).value();
        ASSERT_NEAR(CellGrid::solidAngle(cell), exact, 1e-12);
        sum += CellGrid::solidAngle(cell);
    }
    EXPECT_NEAR(sum, 2 * kPi, 1e-10);
}

TEST(CellGrid, PolesWrapAndHorizon) {
    EXPECT_EQ(CellGrid::cellAt(Direction()), 0U);
    const auto nearTurn = Direction::fromSpherical(30.5_deg, Radians(2 * kPi - 1e-12));
    EXPECT_EQ(CellGrid::place(*CellGrid::cellAt(nearTurn)).sector, CellGrid::sectors(30) - 1);
    EXPECT_EQ(CellGrid::place(*CellGrid::cellAt(Direction::fromSpherical(30.5_deg, 0_deg))).sector,
              0);
    EXPECT_FALSE(CellGrid::cellAt(Direction::fromSpherical(90_deg, 10_deg)));
    EXPECT_FALSE(CellGrid::cellAt(Direction::fromSpherical(120_deg, 10_deg)));
    EXPECT_EQ(CellGrid::place(*CellGrid::cellAt(Direction::fromSpherical(89.999_deg, 0_deg))).row,
              89);
}

}  // namespace
}  // namespace gonio::proc
