#include "proc/table/spherical_lookup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/spherical_tables.h"

namespace gonio::proc {
namespace {

using test::handedValue;
using test::SphericalShape;
using test::sphericalTable;
using test::steps;

SphericalLookup lookup(SphericalTable table) {
    auto channels = bandChannels(table.channels);
    EXPECT_TRUE(channels);
    auto made = SphericalLookup::over(std::move(table), *channels);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return std::move(*made);
}

LightView pairAt(double thetaI, double phiI, double thetaO, double phiO) {
    return {
        .in = Direction::fromSpherical(Radians::fromDegrees(thetaI), Radians::fromDegrees(phiI)),
        .out = Direction::fromSpherical(Radians::fromDegrees(thetaO), Radians::fromDegrees(phiO))};
}

double handed(const LightView& pair, std::size_t) { return handedValue(pair); }

/// Linear in all coordinates of a table, so that interpolation is exact.
double linear(double incidence, double azimuth, double theta) {
    return 1 + incidence / 10 + azimuth / 100 + theta / 1000;
}
SphericalTable linearTable(const SphericalShape& shape) {
    SphericalTable table = sphericalTable(shape, handed);
    for (SphericalBlock& block : table.blocks) {
        for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
            for (std::size_t t = 0; t < block.thetaDeg.size(); ++t) {
                block.f[block.index(a, t)] =
                    linear(block.incidenceDeg, block.azimuthDeg[a], block.thetaDeg[t]);
            }
        }
    }
    return table;
}

TEST(SphericalLookup, AnswersItsOwnNumbersAtNodes) {
    const SphericalLookup at = lookup(
        sphericalTable({.lightAzimuthDeg = {0, 90, 200}, .incidenceDeg = {5, 30, 70}}, handed));
    for (const SphericalBlock& block : at.table().blocks) {
        for (std::size_t a = 0; a + 1 < block.azimuthDeg.size(); ++a) {
            for (std::size_t t = 1; t < block.thetaDeg.size(); ++t) {
                const Answer answer = at.answer(at.table().pairAt(block, a, t));
                EXPECT_EQ(answer.f[Band::G], block.f[block.index(a, t)]);
                EXPECT_EQ(answer.source, Source::Measured);
                EXPECT_TRUE(answer.flags.has(Flag::Measured));
            }
        }
    }
}

TEST(SphericalLookup, IsLinearBetweenNodes) {
    const SphericalLookup at = lookup(linearTable({}));
    std::mt19937_64 random(7);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int i = 0; i < 2000; ++i) {
        const double incidence = uniform(0.01, 59.99);
        const double azimuth = uniform(0, 359.99);
        const double theta = uniform(0.01, 89.99);
        const double light = uniform(0, 360);
        const Answer answer = at.answer(pairAt(incidence, light, theta, light + azimuth));
        ASSERT_NEAR(answer.f[Band::R], linear(incidence, azimuth, theta), 1e-9);
        EXPECT_EQ(answer.source, Source::Interpolated);
        EXPECT_TRUE(answer.flags.has(Flag::Interpolated));
    }
}

TEST(SphericalLookup, CountsAzimuthsFromTheTablesOwnZero) {
    for (const double mirror : {0.0, 90.0, 180.0, 270.0}) {
        const SphericalLookup at = lookup(linearTable({.mirrorAzimuthDeg = mirror}));
        EXPECT_NEAR(
            at.answer(pairAt(20, 50, 30, 50 + 180)).f[Band::R], linear(20, mirror, 30), 1e-9);
        EXPECT_NEAR(
            at.answer(pairAt(20, 50, 30, 50 + 185)).f[Band::R], linear(20, mirror + 5, 30), 1e-9);
    }
}

TEST(SphericalLookup, WrapsAzimuthsThatCoverTheCircle) {
    const SphericalLookup at = lookup(linearTable({.azimuthDeg = steps(0, 350, 10)}));
    EXPECT_NEAR(at.answer(pairAt(20, 0, 30, 355)).f[Band::R],
                (linear(20, 350, 30) + linear(20, 0, 30)) / 2,
                1e-9);
    const SphericalLookup arc = lookup(linearTable({.azimuthDeg = steps(0, 300, 10)}));
    EXPECT_FALSE(arc.answer(pairAt(20, 0, 30, 330)).present());
}

TEST(SphericalLookup, MirrorsAPlaneSymmetricalTable) {
    for (const double first : {0.0, 90.0, 180.0}) {
        const SphericalLookup at =
            lookup(linearTable({.mirrorAzimuthDeg = first + 180,
                                .planeSymmetrical = true,
                                .azimuthDeg = steps(first, first + 180, 10)}));
        for (double azimuth = 0; azimuth <= 180; azimuth += 7.5) {
            const double f = linear(40, first + azimuth, 30);
            EXPECT_NEAR(at.answer(pairAt(40, 33, 30, 33 + azimuth)).f[Band::R], f, 1e-9);
            EXPECT_NEAR(at.answer(pairAt(40, 33, 30, 33 - azimuth)).f[Band::R], f, 1e-9);
        }
    }
}

TEST(SphericalLookup, InterpolatesAcrossTheSeamOfLightAzimuths) {
    SphericalTable table = linearTable({.lightAzimuthDeg = {0, 90, 180, 270}});
    for (SphericalBlock& block : table.blocks) {
        for (double& f : block.f) f = block.lightAzimuthDeg;
    }
    const SphericalLookup at = lookup(std::move(table));
    EXPECT_NEAR(at.answer(pairAt(20, 45, 30, 0)).f[Band::R], 45, 1e-9);
    EXPECT_NEAR(at.answer(pairAt(20, 315, 30, 0)).f[Band::R], 135, 1e-9);
}

TEST(SphericalLookup, IsOneDirectionAtThePole) {
    SphericalTable table = linearTable({.azimuthDeg = steps(100, 200, 10)});
    const double f = table.blocks[1].f[table.blocks[1].index(1, 0)];
    table.blocks[1].f[0] = std::nan("");
    const SphericalLookup at = lookup(std::move(table));
    for (const double light : {0.0, 77.0, 200.0}) {
        EXPECT_EQ(at.answer(pairAt(20, light, 0, 0)).f[Band::R], f);
    }
}

TEST(SphericalLookup, TakesASingleAzimuthAtNormalIncidenceForAll) {
    const SphericalLookup at =
        lookup(sphericalTable({.incidenceDeg = {0, 20}, .azimuthDeg = {180}}, handed));
    const double f = at.answer(pairAt(0, 0, 35, 180)).f[Band::R];
    for (const double azimuth : {0.0, 10.0, 180.0, 299.0}) {
        EXPECT_EQ(at.answer(pairAt(0, 0, 35, azimuth)).f[Band::R], f) << azimuth;
    }
    EXPECT_TRUE(at.answer(pairAt(20, 0, 35, 180)).present());
    EXPECT_FALSE(at.answer(pairAt(20, 0, 35, 170)).present());
}

TEST(SphericalLookup, HasNoAnswerOutsideItsAxesOrWithoutData) {
    SphericalTable table = linearTable({.incidenceDeg = {20, 40}, .thetaDeg = steps(10, 80, 5)});
    table.blocks[0].f[table.blocks[0].index(3, 4)] = std::nan("");
    const SphericalLookup at = lookup(std::move(table));
    for (const LightView& pair : {pairAt(10, 0, 30, 0),
                                  pairAt(50, 0, 30, 0),
                                  pairAt(30, 0, 5, 0),
                                  pairAt(30, 0, 85, 0),
                                  pairAt(20, 0, 30, 30),
                                  pairAt(20, 0, 28, 30),
                                  pairAt(30, 0, 30, 33)}) {
        const Answer answer = at.answer(pair);
        EXPECT_FALSE(answer.present());
        EXPECT_EQ(answer.flags, Flags{});
    }
    EXPECT_TRUE(at.answer(pairAt(40, 0, 30, 30)).present());  // the other incidence is whole
    EXPECT_TRUE(at.answer(pairAt(20, 0, 30, 40)).present());
}

TEST(SphericalLookup, AnswersBelowTheSurfaceFromTransmissionBlocks) {
    SphericalTable table = linearTable({.transmission = false});
    const SphericalTable behind =
        linearTable({.thetaDeg = steps(90, 180, 5), .transmission = true});
    const SphericalLookup front = lookup(table);
    EXPECT_EQ(front.answer(pairAt(20, 0, 120, 0)).flags, Flags{Flag::BelowHorizon});
    table.blocks.insert(table.blocks.end(), behind.blocks.begin(), behind.blocks.end());
    const SphericalLookup both = lookup(table);
    EXPECT_NEAR(both.answer(pairAt(20, 0, 120, 20)).f[Band::R], linear(20, 20, 120), 1e-9);
    EXPECT_NEAR(both.answer(pairAt(20, 0, 60, 20)).f[Band::R], linear(20, 20, 60), 1e-9);
    EXPECT_EQ(both.answer(pairAt(100, 0, 60, 20)).flags, Flags{Flag::BelowHorizon});
}

TEST(SphericalLookup, BlendsWavelengthsIntoBands) {
    SphericalTable table = linearTable({.channels = {{"", 600}, {"", 660}, {"", 525}, {"", 465}}});
    for (SphericalBlock& block : table.blocks) {
        for (double& f : block.f) f = *table.channels[block.channel].nanometres;
    }
    const SphericalLookup at = lookup(std::move(table));
    EXPECT_EQ(at.bandCount(), BandCount::Three);
    const Answer answer = at.answer(pairAt(20, 0, 30, 30));
    EXPECT_NEAR(answer.f[Band::R], 630, 1e-9);
    EXPECT_NEAR(answer.f[Band::G], 525, 1e-9);
    EXPECT_NEAR(answer.f[Band::B], 465, 1e-9);
    EXPECT_EQ(answer.source, Source::Interpolated);
}

TEST(SphericalLookup, RefusesBlocksThatDoNotFit) {
    const BandChannels one{.count = BandCount::One};
    const SphericalTable sound = linearTable({});
    const auto refuses = [&](auto damage) {
        SphericalTable table = sound;
        damage(table);
        const auto made = SphericalLookup::over(std::move(table), one);
        return !made && made.error().kind == ErrorKind::File;
    };
    EXPECT_FALSE(refuses([](SphericalTable&) {}));
    EXPECT_TRUE(refuses([](SphericalTable& t) { t.blocks.clear(); }));
    EXPECT_TRUE(refuses([](SphericalTable& t) { t.blocks[1].f.pop_back(); }));
    EXPECT_TRUE(refuses([](SphericalTable& t) { t.blocks[1].channel = 1; }));
    EXPECT_TRUE(refuses([](SphericalTable& t) { t.blocks[1].thetaDeg[1] = 0; }));
    EXPECT_TRUE(refuses([](SphericalTable& t) { t.blocks[1].azimuthDeg.clear(); }));
    EXPECT_TRUE(refuses([](SphericalTable& t) { t.blocks.push_back(t.blocks[2]); }));
    EXPECT_TRUE(refuses([](SphericalTable& t) { t.channels.clear(); }));
}

}  // namespace
}  // namespace gonio::proc
