#include "proc/table/specular_lookup.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/core/coordinates.h"

namespace gonio::proc {
namespace {

/// f = value(incidence, azimuth, radial), in degrees, at every node above the horizon.
template <class F>
SpecularTable tableOf(TableSymmetry symmetry, const F& value) {
    SpecularTable table;
    table.symmetry = symmetry;
    table.incidenceDeg = {10, 30, 50};
    const double lastAzimuth = symmetry == TableSymmetry::PlaneSymmetrical ? 180 : 360;
    for (double a = 0; a <= lastAzimuth; a += 15) table.azimuthDeg.push_back(a);
    for (double r = 0; r <= 180; r += 10) table.radialDeg.push_back(r);
    TablePlane plane{.f = std::vector<double>(table.nodeCount()), .tis = {0, 0, 0}};
    for (TableNode n; n.incidence < 3; ++n.incidence) {
        for (n.azimuth = 0; n.azimuth < table.azimuthDeg.size(); ++n.azimuth) {
            for (n.radial = 0; n.radial < table.radialDeg.size(); ++n.radial) {
                plane.f[table.index(n)] = table.canHoldData(n)
                                              ? value(table.incidenceDeg[n.incidence],
                                                      table.azimuthDeg[n.azimuth],
                                                      table.radialDeg[n.radial])
                                              : 0;
            }
        }
    }
    table.planes = {plane};
    return table;
}

SpecularLookup lookup(SpecularTable table) {
    auto made = SpecularLookup::over(std::move(table));
    EXPECT_TRUE(made);
    return std::move(*made);
}

/// The pair at an incidence and specular-relative coordinates, in degrees, light at azimuth phi.
LightView pairAt(double incidence, double azimuth, double radial, double phi = 0) {
    const Direction wi =
        Direction::fromSpherical(Radians::fromDegrees(incidence), Radians::fromDegrees(phi));
    return {.in = wi,
            .out = fromSpecularRelative(
                wi, {Radians::fromDegrees(radial), Radians::fromDegrees(azimuth)})};
}

double linear(double i, double a, double r) { return 1 + i / 10 + a / 100 + r / 1000; }

TEST(SpecularLookup, AnswersItsOwnNumbersAtNodes) {
    const SpecularTable table = tableOf(TableSymmetry::PlaneSymmetrical, linear);
    const SpecularLookup at = lookup(table);
    for (TableNode n; n.incidence < 3; ++n.incidence) {
        for (n.azimuth = 0; n.azimuth < table.azimuthDeg.size(); ++n.azimuth) {
            for (n.radial = 1; n.radial < table.radialDeg.size(); ++n.radial) {
                const Answer answer = at.answer(table.pairAt(n));
                if (!table.hasData(0, n)) {
                    EXPECT_FALSE(answer.present());
                    continue;
                }
                EXPECT_EQ(answer.f[Band::G], table.planes[0].f[table.index(n)]);
                EXPECT_EQ(answer.flags, Flags{Flag::Measured});
                EXPECT_EQ(answer.source, Source::Measured);
            }
        }
    }
}

TEST(SpecularLookup, IsLinearBetweenNodes) {
    const SpecularLookup at = lookup(tableOf(TableSymmetry::PlaneSymmetrical, linear));
    const Answer answer = at.answer(pairAt(37, 22, 13));
    EXPECT_NEAR(answer.f[Band::R], linear(37, 22, 13), 1e-12);
    EXPECT_EQ(answer.f[Band::R], answer.f[Band::B]);
    EXPECT_EQ(answer.flags, Flags{Flag::Interpolated});
    EXPECT_EQ(answer.source, Source::Interpolated);
    EXPECT_EQ(at.bandCount(), BandCount::One);
}

TEST(SpecularLookup, TakesTheFirstIncidenceBelowItAndNothingAboveTheLast) {
    const SpecularLookup at = lookup(tableOf(TableSymmetry::PlaneSymmetrical, linear));
    EXPECT_NEAR(at.answer(pairAt(0, 60, 20)).f[Band::G], linear(10, 60, 20), 1e-12);
    EXPECT_NEAR(at.answer(pairAt(5, 60, 20)).f[Band::G], linear(10, 60, 20), 1e-12);
    EXPECT_TRUE(at.answer(pairAt(50, 60, 20)).present());
    const Answer above = at.answer(pairAt(50.1, 60, 20));
    EXPECT_FALSE(above.present());
    EXPECT_EQ(above.flags, Flags{});
}

TEST(SpecularLookup, MirrorsAPlaneSymmetricalTable) {
    const SpecularLookup at = lookup(tableOf(TableSymmetry::PlaneSymmetrical, linear));
    for (double azimuth : {10.0, 75.0, 91.0, 170.0}) {
        const double f = at.answer(pairAt(30, azimuth, 25)).f[Band::G];
        EXPECT_NEAR(at.answer(pairAt(30, 360 - azimuth, 25)).f[Band::G], f, 1e-12);
    }
}

TEST(SpecularLookup, DoesNotDependOnTheLightsAzimuthWithOneRotation) {
    const SpecularLookup at = lookup(tableOf(TableSymmetry::Asymmetrical, linear));
    const double f = at.answer(pairAt(20, 200, 25)).f[Band::G];
    for (double phi : {1.0, 90.0, 179.0, 300.0}) {
        EXPECT_NEAR(at.answer(pairAt(20, 200, 25, phi)).f[Band::G], f, 1e-12);
    }
}

TEST(SpecularLookup, AzimuthNinetyIsPlusYForLightOnPlusX) {
    const auto lobe = [](double, double a, double) { return a > 0 && a < 180 ? 2.0 : 1.0; };
    const SpecularLookup at = lookup(tableOf(TableSymmetry::Asymmetrical, lobe));
    const Direction wi = Direction::fromSpherical(30_deg, 0_deg);
    const auto seen = [&](double y) {
        return at.answer({wi, *Direction::fromVector({-0.4, y, 0.8})}).f[Band::G];
    };
    EXPECT_DOUBLE_EQ(seen(0.3), 2.0);
    EXPECT_LT(seen(-0.3), 1.5);
}

TEST(SpecularLookup, PutsAzimuthZeroOnTheSideOfTheNormal) {
    const auto lobe = [](double, double a, double) { return a <= 15 ? 2.0 : 1.0; };
    const SpecularLookup at = lookup(tableOf(TableSymmetry::PlaneSymmetrical, lobe));
    const Direction wi = Direction::fromSpherical(50_deg, 0_deg);
    EXPECT_DOUBLE_EQ(at.answer({wi, Direction::fromSpherical(20_deg, 180_deg)}).f[Band::G], 2.0);
    EXPECT_DOUBLE_EQ(at.answer({wi, Direction::fromSpherical(70_deg, 180_deg)}).f[Band::G], 1.0);
}

TEST(SpecularLookup, AnswersNothingNextToAMissingNodeAndNothingBelowTheHorizon) {
    SpecularTable table = tableOf(TableSymmetry::PlaneSymmetrical, linear);
    table.planes[0].f[table.index({0, 1, 4, 2})] = 0;  // 30, 60, 20 degrees
    const SpecularLookup at = lookup(table);
    EXPECT_FALSE(at.answer(pairAt(30, 60, 20)).present());
    EXPECT_FALSE(at.answer(pairAt(30, 58, 19)).present());
    EXPECT_FALSE(at.answer(pairAt(29, 58, 19)).present());
    EXPECT_TRUE(at.answer(pairAt(30, 60, 30)).present());  // a node beside it answers
    EXPECT_TRUE(at.answer(pairAt(10, 60, 20)).present());  // and so does another incidence
    const Answer below = at.answer(pairAt(30, 180, 70));
    EXPECT_FALSE(below.present());
    EXPECT_EQ(below.flags, Flags{Flag::BelowHorizon});
    EXPECT_FALSE(at.answer(pairAt(30, 180, 59)).present());  // its outer neighbour is below
}

TEST(SpecularLookup, TurnsTheLightByMinusTheRotation) {
    SpecularTable table = tableOf(TableSymmetry::Asymmetrical, linear);
    table.symmetry = TableSymmetry::Asymmetrical4D;
    table.rotationDeg = {0, 90, 180, 270};
    std::vector<double> all;
    for (double scale : {1.0, 2.0, 3.0, 4.0}) {
        for (double f : table.planes[0].f) all.push_back(scale * f);
    }
    table.planes[0].f = all;
    const SpecularLookup at = lookup(table);
    const double f = linear(30, 45, 20);
    EXPECT_NEAR(at.answer(pairAt(30, 45, 20, 0)).f[Band::G], f, 1e-12);
    EXPECT_NEAR(at.answer(pairAt(30, 45, 20, -90)).f[Band::G], 2 * f, 1e-12);
    EXPECT_NEAR(at.answer(pairAt(30, 45, 20, -45)).f[Band::G], 1.5 * f, 1e-12);
    EXPECT_NEAR(at.answer(pairAt(30, 45, 20, 45)).f[Band::G], 2.5 * f, 1e-12);
    EXPECT_NEAR(at.answer(table.pairAt({1, 1, 3, 2})).f[Band::G], 2 * f, 1e-12);
}

TEST(SpecularLookup, RefusesWhatHasNoFOfTheLedBands) {
    SpecularTable xyz = tableOf(TableSymmetry::PlaneSymmetrical, linear);
    xyz.colour = TableColour::Xyz;
    xyz.planes.resize(3, xyz.planes[0]);
    SpecularTable two = tableOf(TableSymmetry::PlaneSymmetrical, linear);
    two.colour = TableColour::LedBands;
    two.planes.resize(2, two.planes[0]);
    SpecularTable torn = tableOf(TableSymmetry::PlaneSymmetrical, linear);
    torn.planes[0].f.pop_back();
    for (const SpecularTable& table : {xyz, two, torn, SpecularTable{}}) {
        const auto made = SpecularLookup::over(table);
        ASSERT_FALSE(made);
        EXPECT_EQ(made.error().kind, ErrorKind::File);
    }
}

TEST(SpecularLookup, AnswersTransmissionBelowTheSurfaceAndNotAbove) {
    SpecularTable table = tableOf(TableSymmetry::PlaneSymmetrical, linear);
    table.kind = ScatterKind::Btdf;
    const SpecularLookup at = lookup(table);
    const LightView pair = table.pairAt({0, 1, 1, 1});
    EXPECT_LT(pair.out.z(), 0);
    const Answer answer = at.answer(pair);
    EXPECT_EQ(answer.source, Source::Measured);
    EXPECT_NEAR(answer.f[Band::G], table.planes[0].f[table.index({0, 1, 1, 1})], 1e-12);
    const Answer above = at.answer({.in = pair.in, .out = acrossSurface(pair.out)});
    EXPECT_TRUE(std::isnan(above.f[Band::G]));
    EXPECT_TRUE(above.flags.has(Flag::BelowHorizon));
}

TEST(SpecularLookup, AnswersBandByBandWhereThereAreThree) {
    SpecularTable table = tableOf(TableSymmetry::PlaneSymmetrical, linear);
    table.colour = TableColour::LedBands;
    table.planes.resize(3, table.planes[0]);
    for (double& f : table.planes[1].f) f *= 2;
    table.planes[2].f[table.index({0, 1, 1, 1})] = std::numeric_limits<double>::quiet_NaN();
    const SpecularLookup at = lookup(table);
    EXPECT_EQ(at.bandCount(), BandCount::Three);
    const Answer answer = at.answer(table.pairAt({0, 1, 1, 1}));
    EXPECT_EQ(answer.f[Band::G], 2 * answer.f[Band::R]);
    EXPECT_TRUE(std::isnan(answer.f[Band::B]));
    EXPECT_TRUE(answer.flags.has(Flag::Measured));
}

/// Axes at the centres of cells, smooth f = 1 + x / 10 + y / 20 about the mirror direction.
SpecularTable centredTable(TableSymmetry symmetry) {
    SpecularTable table;
    table.symmetry = symmetry;
    table.colour = TableColour::LedBands;
    table.incidenceDeg = {0, 40};
    const bool half = symmetry == TableSymmetry::PlaneSymmetrical;
    for (int i = 0; i < (half ? 18 : 36); ++i) table.azimuthDeg.push_back(10 * i + 5);
    for (int j = 0; j < 36; ++j) table.radialDeg.push_back(5 * j + 2.5);
    TablePlane plane{.f = std::vector<double>(table.nodeCount()), .tis = {0, 0}};
    for (TableNode n; n.incidence < 2; ++n.incidence) {
        for (n.azimuth = 0; n.azimuth < table.azimuthDeg.size(); ++n.azimuth) {
            for (n.radial = 0; n.radial < table.radialDeg.size(); ++n.radial) {
                const Radians a = Radians::fromDegrees(table.azimuthDeg[n.azimuth]);
                const double r = table.radialDeg[n.radial];
                plane.f[table.index(n)] = 3 + r * cos(a) / 100 + (half ? 0 : r * sin(a) / 50);
            }
        }
    }
    table.planes = {plane, plane, plane};
    for (double& f : table.planes[2].f) f *= 2;
    return table;
}

TEST(SpecularLookup, GoesOverThePoleOfCellCentres) {
    const SpecularLookup at = lookup(centredTable(TableSymmetry::Asymmetrical));
    for (const double azimuth : {0.0, 45.0, 123.0, 359.0}) {
        EXPECT_NEAR(at.answer(pairAt(40, azimuth, 0)).f[Band::R], 3, 1e-9);
        const Radians a = Radians::fromDegrees(azimuth);
        for (const double radial : {0.01, 1.0, 2.4}) {
            const double f = 3 + radial * cos(a) / 100 + radial * sin(a) / 50;
            // Linear between azimuths 10 degrees apart: 0.4 % of the slope.
            EXPECT_NEAR(at.answer(pairAt(40, azimuth, radial)).f[Band::R], f, 2e-4);
        }
    }
    EXPECT_TRUE(at.answer(pairAt(40, 5, 1)).flags.has(Flag::Interpolated));
}

TEST(SpecularLookup, HasNoAnswerAtAPoleWhoseRingIsNotWhole) {
    SpecularTable table = centredTable(TableSymmetry::Asymmetrical);
    table.planes[1].f[table.index({0, 1, 20, 0})] = 0;
    const SpecularLookup at = lookup(table);
    EXPECT_TRUE(std::isnan(at.answer(pairAt(40, 5, 1)).f[Band::G]));
    EXPECT_FALSE(std::isnan(at.answer(pairAt(40, 5, 1)).f[Band::R]));
    EXPECT_TRUE(at.answer(pairAt(40, 5, 2.5)).present());
}

TEST(SpecularLookup, GoesOnToTheMirrorPlaneFromCellCentres) {
    const SpecularLookup at = lookup(centredTable(TableSymmetry::PlaneSymmetrical));
    const double beside = at.answer(pairAt(40, 5, 20)).f[Band::R];
    for (const double azimuth : {0.0, 2.0, 355.0, 359.5}) {
        EXPECT_NEAR(at.answer(pairAt(40, azimuth, 20)).f[Band::R], beside, 1e-12) << azimuth;
    }
    const double behind = at.answer(pairAt(40, 175, 20)).f[Band::R];
    EXPECT_NEAR(at.answer(pairAt(40, 180, 20)).f[Band::R], behind, 1e-12);
}

TEST(SpecularLookup, KeepsTheGapBeforeAFirstRadialOfAWholeStep) {
    SpecularTable table = tableOf(TableSymmetry::Asymmetrical, linear);
    table.radialDeg.erase(table.radialDeg.begin());  // 10, 20, ...
    TablePlane& plane = table.planes[0];
    plane.f.assign(table.nodeCount(), 1);
    EXPECT_FALSE(lookup(table).answer(pairAt(30, 0, 5)).present());
}

TEST(SpecularLookup, RefusesPlanesThatAreNotItsColours) {
    SpecularTable table = centredTable(TableSymmetry::Asymmetrical);
    table.planes.pop_back();
    EXPECT_FALSE(SpecularLookup::over(table));
}

}  // namespace
}  // namespace gonio::proc
