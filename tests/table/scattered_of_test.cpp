#include "proc/table/scattered_of.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/core/coordinates.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

double byPosition(Radians incidence, const Direction& wo) {
    return 1 + incidence.value() + 0.3 * wo.x() + 0.2 * wo.y();
}

std::size_t cellsBelow(int row) { return CellGrid::index({row, 0}); }

TEST(ScatteredOf, TakesTheUsableCellsOfAMeasuredSample) {
    SampleSet sample = test::sampleSet(byPosition);
    // Saturated in one band: no sample of three bands.
    sample.leds[1].bands[index(Band::G)].flags[100].set(Flag::Saturated);
    const auto made = scatteredOf(sample);
    ASSERT_TRUE(made);
    const std::size_t seen = cellsBelow(75);
    EXPECT_EQ(made->set.size(), 4 * seen - 1);
    EXPECT_EQ(made->leftOut, 4 * (CellGrid::count() - seen) + 1);
    EXPECT_EQ(made->set.bandCount(), BandCount::Three);
    EXPECT_EQ(made->set.symmetry(), PairSymmetry::Isotropic);

    const Direction wi = Direction::fromSpherical(40_deg, Radians(0));
    const Direction wo = CellGrid::centre(5000);
    const auto found = made->set.nearest({wi, wo}, {.count = 1, .maxDistance = 1e-12});
    ASSERT_EQ(found.size(), 1U);
    const ScatteredSample* cell = made->set.find(found.front().id);
    const double f = byPosition(40_deg, wo);
    EXPECT_EQ(cell->f, (LedBands{{f, 2 * f, 3 * f}}));
    EXPECT_EQ(cell->uRandom, LedBands::all(0.01 * f));
    EXPECT_EQ(cell->uSystematic, LedBands::all(0.02 * f));
    EXPECT_EQ(cell->flags, Flags{Flag::Measured});
}

TEST(ScatteredOf, TakesOneBandForAllThree) {
    SampleSet sample = test::sampleSet(byPosition);
    for (LedTable& led : sample.leds) led.bands[index(Band::R)] = {};
    const auto whole = scatteredOf(sample);
    ASSERT_TRUE(whole);
    EXPECT_TRUE(whole->set.empty());
    const auto blue = scatteredOf(sample, Band::B);
    ASSERT_TRUE(blue);
    EXPECT_EQ(blue->set.size(), 4 * cellsBelow(75));
    EXPECT_EQ(blue->set.bandCount(), BandCount::One);
    const double f = byPosition(0_deg, CellGrid::centre(0));
    EXPECT_EQ(blue->set.find(0)->f, LedBands::all(3 * f));
}

TEST(ScatteredOf, OfNoCellsIsEmpty) {
    const auto made = scatteredOf(SampleSet{});
    ASSERT_TRUE(made);
    EXPECT_TRUE(made->set.empty());
}

SpecularTable table(TableSymmetry symmetry, double lastAzimuth) {
    SpecularTable table{.symmetry = symmetry};
    table.incidenceDeg = {0, 30};
    for (double a = 0; a <= lastAzimuth; a += 45) table.azimuthDeg.push_back(a);
    table.radialDeg = {0, 20, 40, 100};
    TablePlane plane{.f = std::vector(table.nodeCount(), 0.25), .tis = {0, 0}};
    plane.f[table.index({0, 1, 1, 2})] = 0;  // no data
    table.planes = {plane};
    return table;
}

TEST(ScatteredOf, TakesEachDirectionOfATableOnce) {
    const auto made = scatteredOf(table(TableSymmetry::Asymmetrical, 360));
    ASSERT_TRUE(made);
    // At the normal: the pole and two rings of 8; radial 100 is below the horizon. At 30 degrees
    // the same with one missing, and radial 100 above it towards the normal: at azimuths -45,
    // 0, 45.
    EXPECT_EQ(made->set.size(), 17U + 17U - 1U + 3U);
    EXPECT_EQ(made->leftOut, 1U);
    EXPECT_EQ(made->set.bandCount(), BandCount::One);
    EXPECT_EQ(made->set.symmetry(), PairSymmetry::Isotropic);
    for (const SampleId a : made->set.ids()) {
        if (made->set.find(a)->pair.in.theta() == Radians(0)) continue;
        const auto same =
            made->set.nearest(made->set.find(a)->pair, {.count = 2, .maxDistance = 1e-9});
        EXPECT_EQ(same.size(), 1U);
    }
}

TEST(ScatteredOf, TakesTheSymmetryOfTheTable) {
    const auto half = scatteredOf(table(TableSymmetry::PlaneSymmetrical, 180));
    ASSERT_TRUE(half);
    EXPECT_EQ(half->set.symmetry(), PairSymmetry::Plane);
    SpecularTable rotated = table(TableSymmetry::Asymmetrical4D, 360);
    rotated.rotationDeg = {0, 90};
    rotated.planes[0].f.resize(rotated.nodeCount(), 0.5);
    const auto turned = scatteredOf(rotated);
    ASSERT_TRUE(turned);
    EXPECT_EQ(turned->set.symmetry(), PairSymmetry::None);
}

TEST(ScatteredOf, RefusesXyzAndTransmission) {
    SpecularTable xyz = table(TableSymmetry::Asymmetrical, 360);
    xyz.colour = TableColour::Xyz;
    SpecularTable through = table(TableSymmetry::Asymmetrical, 360);
    through.kind = ScatterKind::Btdf;
    for (const SpecularTable& bad : {xyz, through}) {
        const auto made = scatteredOf(bad);
        ASSERT_FALSE(made);
        EXPECT_EQ(made.error().kind, ErrorKind::Usage);
    }
}

}  // namespace
}  // namespace gonio::proc
