#include "proc/calibrate/local_shape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

constexpr double kPerDegree = 180 / kPi;

/// f = value(theta in radians, phi in radians) everywhere, known to a thousandth of itself.
template <class F>
CellSamples field(const F& value) {
    CellSamples cells = CellSamples::missing(CellGrid::count());
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const Direction centre = CellGrid::centre(cell);
        cells.f[cell] = value(centre.theta().value(), centre.phi().value());
        cells.uRandom[cell] = 1e-3 * std::abs(cells.f[cell]);
        cells.flags[cell].set(Flag::Measured);
    }
    return cells;
}

std::size_t cellAt(double theta, double phi) {
    return *CellGrid::cellAt(
        Direction::fromSpherical(Radians::fromDegrees(theta), Radians::fromDegrees(phi)));
}

TEST(LocalShape, AFlankThatFallsByAFactorFromCellToCellHasItsOwnSlope) {
    const double steep = 2 * kPerDegree;
    const CellSamples cells = field([&](double theta, double) { return std::exp(-steep * theta); });
    const std::size_t cell = cellAt(40.5, 30);
    const LocalShape shape = localShape(cells, cell);
    const double f = cells.f[cell];
    EXPECT_TRUE(shape.logarithmic);
    EXPECT_NEAR(shape.slope(f) / f, steep, 1e-6 * steep);
    const double off = 0.1 / kPerDegree;
    EXPECT_NEAR(shape.at(f, off, 0) / f, std::exp(-0.2), 1e-6);
    // f'' = steep^2 f along theta alone: sqrt(1/4 + 1/2) of it times u^2.
    EXPECT_NEAR(shape.secondOrder(f, DirectionSpread::even(Radians(off))) / f,
                std::sqrt(0.75) * 0.04,
                1e-6);
    EXPECT_NEAR(shape.laplacian(f) / f, steep * steep, 1e-6 * steep * steep);
}

TEST(LocalShape, WhereFIsLostInNoiseDifferencesOfFCount) {
    CellSamples cells = field([](double theta, double) { return 0.01 * theta; });
    for (double& u : cells.uRandom) u = 1;
    const std::size_t cell = cellAt(40.5, 30);
    const LocalShape shape = localShape(cells, cell);
    EXPECT_FALSE(shape.logarithmic);
    EXPECT_NEAR(shape.slope(cells.f[cell]), 0.01, 1e-9);
    EXPECT_NEAR(shape.at(cells.f[cell], 0.1, 0), cells.f[cell] + 0.001, 1e-9);
}

TEST(LocalShape, CurvatureAlongEachDirection) {
    CellSamples along = field([](double theta, double) { return 3 * theta * theta; });
    CellSamples across = field([](double theta, double phi) {
        const double y = (phi - 0.5) * std::sin(theta);
        return 5 * y * y;
    });
    const std::size_t cell = cellAt(60.5, 0.5 * kPerDegree);
    for (CellSamples* cells : {&along, &across}) {
        for (double& u : cells->uRandom) u = 10;
    }
    EXPECT_NEAR(localShape(along, cell).theta.curvature, 6, 1e-6);
    EXPECT_NEAR(localShape(along, cell).phi.curvature, 0, 1e-6);
    EXPECT_NEAR(localShape(across, cell).phi.curvature, 10, 1e-6);
}

TEST(LocalShape, OneNeighbourGivesASlopeAndNoneNothing) {
    CellSamples cells = field([](double theta, double) { return 1 + theta; });
    for (double& u : cells.uRandom) u = 1;
    const std::size_t cell = cellAt(40.5, 30);
    for (std::size_t other = 0; other < cells.size(); ++other) {
        if (CellGrid::place(other).row == 39) cells.flags[other] = {};
    }
    const LocalShape one = localShape(cells, cell);
    EXPECT_NEAR(one.theta.slope, 1, 1e-9);
    EXPECT_EQ(one.theta.curvature, 0);
    for (std::size_t other = 0; other < cells.size(); ++other) {
        if (other != cell) cells.flags[other] = {};
    }
    const LocalShape none = localShape(cells, cell);
    EXPECT_EQ(none.slope(cells.f[cell]), 0);
    EXPECT_EQ(none.secondOrder(cells.f[cell], DirectionSpread::even(Radians(1))), 0);
}

TEST(LocalShape, IsFiniteInEveryCell) {
    const CellSamples cells = field([](double theta, double phi) { return theta * std::cos(phi); });
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const LocalShape shape = localShape(cells, cell);
        ASSERT_TRUE(std::isfinite(shape.slope(cells.f[cell]))) << cell;
        ASSERT_TRUE(
            std::isfinite(shape.secondOrder(cells.f[cell], DirectionSpread::even(Radians(1e-3)))))
            << cell;
    }
}

}  // namespace
}  // namespace gonio::proc
