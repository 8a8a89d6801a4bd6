#include "proc/estimate/sheet.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

Sheet::Cells constantTo(int rows, double value) {
    Sheet::Cells cells = Sheet::Cells::missing();
    for (std::size_t i = 0; i < cells.value.size(); ++i) {
        if (CellGrid::place(i).row >= rows) continue;
        cells.value[i] = value;
        cells.uRandom[i] = 0.1;
        cells.uSystematic[i] = 0.2;
    }
    return cells;
}

TEST(Neighbours, TouchAndAreMutual) {
    for (std::size_t cell = 0; cell < CellGrid::count(); cell += 7) {
        for (const std::uint32_t near : neighboursOf(cell)) {
            const auto& back = neighboursOf(near);
            EXPECT_NE(std::find(back.begin(), back.end(), cell), back.end()) << cell << " " << near;
            const Radians apart =
                angleBetween({.in = CellGrid::centre(cell), .out = CellGrid::centre(near)});
            EXPECT_LT(apart.degrees(), 2.1);
        }
        EXPECT_GE(neighboursOf(cell).size(), 4U);
    }
}

TEST(Sheet, IsEmptyWithoutAValue) { EXPECT_FALSE(Sheet::over(Sheet::Cells::missing())); }

TEST(Sheet, KeepsAConstantBeyondItsEdgeAndCountsTheSteps) {
    const auto sheet = Sheet::over(constantTo(75, 3));
    ASSERT_TRUE(sheet);
    for (const double theta : {0.0, 30.0, 74.0, 80.0, 89.9}) {
        const SheetValue at =
            sheet->at(Direction::fromSpherical(Radians::fromDegrees(theta), 1_deg));
        EXPECT_NEAR(at.value, 3, 1e-12) << theta;
        EXPECT_NEAR(at.uSystematic, 0.2, 1e-12);
    }
    EXPECT_EQ(sheet->at(CellGrid::centre(0)).steps, 0);
    EXPECT_EQ(sheet->at(Direction::fromSpherical(Radians::fromDegrees(79.5), 0_deg)).steps, 5);
}

TEST(Sheet, AnswersTheCellItselfAtItsCentre) {
    Sheet::Cells cells = constantTo(75, 1);
    cells.value[4321] = 17;
    const auto sheet = Sheet::over(cells);
    EXPECT_DOUBLE_EQ(sheet->at(CellGrid::centre(4321)).value, 17);
    EXPECT_DOUBLE_EQ(sheet->at(CellGrid::centre(4321)).uRandom, 0.1);
}

TEST(Sheet, FillsAHoleFromItsRimOnly) {
    Sheet::Cells cells = constantTo(75, 2);
    const Direction hole = Direction::fromSpherical(40_deg, 90_deg);
    for (std::size_t i = 0; i < cells.value.size(); ++i) {
        const Radians away = angleBetween({.in = hole, .out = CellGrid::centre(i)});
        if (away < 4_deg) cells.value[i] = std::nan("");
        // What lies inside the rim of the hole would show at once.
        if (away >= 4_deg && away < 5.5_deg) cells.value[i] = 5;
    }
    const auto sheet = Sheet::over(cells);
    const SheetValue inside = sheet->at(hole);
    EXPECT_GT(inside.value, 4.5);
    EXPECT_LE(inside.value, 5);
    EXPECT_GE(inside.steps, 2);
}

TEST(Sheet, StandsOnOneCell) {
    Sheet::Cells cells = Sheet::Cells::missing();
    cells.value[0] = -1e-3;
    cells.uRandom[0] = cells.uSystematic[0] = 0;
    const auto sheet = Sheet::over(cells);
    ASSERT_TRUE(sheet);
    EXPECT_DOUBLE_EQ(sheet->at(Direction::fromSpherical(89_deg, 200_deg)).value, -1e-3);
}

}  // namespace
}  // namespace gonio::proc
