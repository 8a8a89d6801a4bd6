#include "proc/table/rows_of.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/table/rotations.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double asymmetric(Radians incidence, const Direction& wo) {
    return 1 + incidence.value() + 0.3 * wo.x() + 0.2 * wo.y();
}

/// Whatever its bits are, NaN included.
bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Cells whose value, uncertainties or flags differ.
std::size_t differing(const CellSamples& a, const CellSamples& b) {
    if (a.size() != b.size()) return std::max(a.size(), b.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const bool equal = same(a.f[i], b.f[i]) && same(a.uRandom[i], b.uRandom[i]) &&
                           same(a.uSystematic[i], b.uSystematic[i]) && a.flags[i] == b.flags[i];
        if (!equal) ++count;
    }
    return count;
}

void expectSame(const SampleSet& a, const SampleSet& b) {
    EXPECT_EQ(a.info, b.info);
    ASSERT_EQ(a.leds.size(), b.leds.size());
    for (std::size_t i = 0; i < a.leds.size(); ++i) {
        EXPECT_EQ(a.leds[i].incidence, b.leds[i].incidence);
        EXPECT_EQ(a.leds[i].rotation, b.leds[i].rotation);
        for (const Band band : kBands) {
            const auto at = index(band);
            EXPECT_EQ(differing(a.leds[i].bands[at], b.leds[i].bands[at]), 0U) << i;
        }
    }
}

SampleSet back(const BrdfRows& rows, const SampleInfo& info = {}) {
    const auto made = sampleOf(rows, metadataOf(info));
    EXPECT_TRUE(made) << made.error().message;
    return made ? made->set : SampleSet{};
}

TEST(RowsOf, GiveASampleBackToTheBit) {
    const SampleSet set = test::sampleSet(asymmetric);
    const BrdfRows rows = rowsOf(set);
    EXPECT_EQ(rows.channels, Channel::ofBands());
    EXPECT_EQ(rows.pairs.size(), 4 * CellGrid::count());
    EXPECT_TRUE(rows.isotropic);
    expectSame(back(rows, set.info), set);
    const auto made = sampleOf(rows, {});
    ASSERT_TRUE(made);
    EXPECT_EQ(made->values, 3 * 4 * CellGrid::index({75, 0}));
    EXPECT_EQ(made->leftOut + made->offCentre + made->averaged, 0U);
    EXPECT_FALSE(made->bandsResampled);
}

TEST(RowsOf, GiveTheRotationsOfASampleBack) {
    SampleSet set;
    for (const double rotation : {0.0, 45.0, 100.0}) {
        for (const Radians incidence : {20_deg, 60_deg}) {
            set.leds.push_back(test::ledTable(incidence, [&](Radians, const Direction& wo) {
                return asymmetric(incidence, wo) + rotation;
            }));
            set.leds.back().rotation = rotationOf(rotation);
        }
    }
    const BrdfRows rows = rowsOf(set);
    EXPECT_FALSE(rows.isotropic);
    expectSame(back(rows), set);

    SampleSet one;
    one.leds = {set.leds[2], set.leds[3]};
    one.leds.insert(one.leds.begin(), test::ledTable(0_deg, asymmetric));
    one.leds[0].rotation = rotationOf(45);
    EXPECT_TRUE(rowsOf(one).isotropic);
    expectSame(back(rowsOf(one)), one);
}

TEST(RowsOf, GiveTheNormalToEachRotation) {
    SampleSet set;
    for (const double rotation : {0.0, 90.0}) {
        set.leds.push_back(test::ledTable(30_deg, asymmetric));
        set.leds.back().rotation = rotationOf(rotation);
    }
    set.leds.insert(set.leds.begin(), test::ledTable(0_deg, asymmetric));
    const SampleSet made = back(rowsOf(set));
    ASSERT_EQ(made.leds.size(), 4U);
    EXPECT_EQ(differing(made.leds[0].bands[0], set.leds[0].bands[0]), 0U);
    EXPECT_EQ(made.leds[2].incidence, 0_deg);
    EXPECT_EQ(made.leds[2].rotation, rotationOf(90));
    // The rig sees at phi what lies at phi - 90 degrees on the sample.
    const std::size_t seen = *CellGrid::cellAt(Direction::fromSpherical(40.5_deg, 100_deg));
    const std::size_t lies = *CellGrid::cellAt(Direction::fromSpherical(40.5_deg, 10_deg));
    EXPECT_NEAR(made.leds[2].bands[0].f[seen], set.leds[0].bands[0].f[lies], 0.02);
}

TEST(RowsOf, KeepOnlyTheBandsThatAreThere) {
    SampleSet set = test::sampleSet(asymmetric);
    for (LedTable& led : set.leds) led.bands[index(Band::R)] = led.bands[index(Band::B)] = {};
    const BrdfRows rows = rowsOf(set);
    EXPECT_EQ(rows.channels, std::vector<Channel>{Channel::of(Band::G)});
    expectSame(back(rows, set.info), set);
    EXPECT_TRUE(rowsOf(SampleSet{}).pairs.empty());
}

BrdfRows oneRow(const LightView& pair, double f) {
    return {.channels = {Channel{}},
            .pairs = {pair},
            .f = {f},
            .uRandom = {},
            .uSystematic = {},
            .flags = {}};
}
LightView pairOf(Radians thetaI, Radians phiI, Radians thetaO, Radians phiO) {
    return {.in = Direction::fromSpherical(thetaI, phiI),
            .out = Direction::fromSpherical(thetaO, phiO)};
}

TEST(SampleOf, TurnsIsotropicRowsOfSeveralAzimuthsToZero) {
    BrdfRows rows = oneRow(pairOf(30_deg, 0_deg, 20_deg, 70_deg), 0.25);
    rows.pairs.push_back(pairOf(30_deg, 200_deg, 20_deg, 310_deg));
    rows.f.push_back(0.75);
    const auto made = sampleOf(rows, {});
    ASSERT_TRUE(made);
    ASSERT_EQ(made->set.leds.size(), 1U);
    const std::size_t first = *CellGrid::cellAt(Direction::fromSpherical(20_deg, 70_deg));
    const std::size_t second = *CellGrid::cellAt(Direction::fromSpherical(20_deg, 110_deg));
    EXPECT_EQ(made->set.leds[0].bands[1].f[first], 0.25);
    EXPECT_EQ(made->set.leds[0].bands[2].f[second], 0.75);
    rows.isotropic = false;
    EXPECT_EQ(back(rows).leds.size(), 2U);
}

TEST(SampleOf, TakesTheMeanOfSeveralWithTheirUncertainties) {
    BrdfRows rows = oneRow(pairOf(30_deg, 0_deg, 20.2_deg, 70_deg), 0.25);
    rows.pairs.push_back(pairOf(30_deg, 0_deg, 20.4_deg, 70_deg));
    rows.f.push_back(0.75);
    rows.uRandom = {0.03, 0.04};
    rows.uSystematic = {0.1, 0.3};
    const auto made = sampleOf(rows, {});
    ASSERT_TRUE(made);
    const std::size_t cell = *CellGrid::cellAt(rows.pairs[0].out);
    const Measured<double> mean = made->set.leds[0].bands[0].at(cell);
    EXPECT_EQ(mean.value, 0.5);
    EXPECT_NEAR(mean.uRandom, 0.025, 1e-15);  // sqrt(3^2 + 4^2) / 2: two roundings
    EXPECT_EQ(mean.uSystematic, 0.2);
    EXPECT_TRUE(mean.present());
    EXPECT_EQ(made->averaged, 6U);  // two values in each of three bands
    EXPECT_EQ(made->offCentre, 6U);
}

TEST(SampleOf, CountsWhatItLeavesOut) {
    BrdfRows rows = oneRow(pairOf(30_deg, 0_deg, 120_deg, 0_deg), 1);
    rows.pairs.push_back(pairOf(100_deg, 0_deg, 20_deg, 0_deg));
    rows.f.push_back(1);
    rows.pairs.push_back(pairOf(30_deg, 0_deg, 20_deg, 0_deg));
    rows.f.push_back(kNan);
    rows.channels = {Channel::of(Band::B)};
    const auto made = sampleOf(rows, {});
    ASSERT_TRUE(made);
    EXPECT_EQ(made->values, 2U);
    EXPECT_EQ(made->leftOut, 2U);
    ASSERT_EQ(made->set.leds.size(), 1U);
    EXPECT_EQ(made->set.leds[0].bands[0].size(), 0U);
    for (const double f : made->set.leds[0].bands[2].f) {
        if (!std::isnan(f)) FAIL() << "a value from nowhere";
    }
}

TEST(SampleOf, RefusesWhatIsNoBandOrHasTooManyLights) {
    BrdfRows rows = oneRow(pairOf(30_deg, 0_deg, 20_deg, 0_deg), 1);
    rows.channels = {{"X", {}}};
    EXPECT_EQ(sampleOf(rows, {}).error().kind, ErrorKind::Usage);
    rows.channels = {Channel{}};
    for (int i = 0; i < 201; ++i) {
        rows.pairs.push_back(pairOf(Radians(0.005 * i), 0_deg, 20_deg, 0_deg));
        rows.f.push_back(1);
    }
    EXPECT_EQ(sampleOf(rows, {}).error().kind, ErrorKind::Usage);
}

TEST(RowsOf, TakeEachNodeOfASpecularTableOnce) {
    SpecularTable table{.symmetry = TableSymmetry::Asymmetrical};
    table.incidenceDeg = {0, 30};
    for (double a = 0; a <= 360; a += 45) table.azimuthDeg.push_back(a);
    table.radialDeg = {0, 20, 40, 100};
    table.planes = {{.f = std::vector(table.nodeCount(), 0.25), .tis = {0, 0}}};
    table.planes[0].f[table.index({0, 1, 1, 2})] = 0;
    const BrdfRows rows = rowsOf(table, Channel::of(Band::G));
    EXPECT_EQ(rows.pairs.size(), 17U + 17U - 1U + 3U);
    EXPECT_EQ(rows.channels, std::vector<Channel>{Channel::of(Band::G)});
    table.kind = ScatterKind::Btdf;
    const BrdfRows through = rowsOf(table);
    ASSERT_EQ(through.pairs.size(), rows.pairs.size());
    for (std::size_t i = 0; i < rows.pairs.size(); ++i) {
        // Normalised once more: an ulp.
        EXPECT_NEAR(through.pairs[i].out.z(), -rows.pairs[i].out.z(), 1e-15);
    }
    table.colour = TableColour::Xyz;
    table.planes.resize(3, table.planes[0]);
    table.planes[2].f[table.index({0, 0, 0, 0})] = 0;
    const BrdfRows xyz = rowsOf(table);
    EXPECT_EQ(xyz.pairs.size(), rows.pairs.size());
    EXPECT_TRUE(xyz.hasData(0, 1));
    EXPECT_FALSE(xyz.hasData(0, 2));
}

TEST(RowsOf, JoinTheBlocksOfASphericalTableByChannel) {
    SphericalTable table;
    table.channels = Channel::ofBands();
    for (std::size_t channel = 0; channel < 3; ++channel) {
        SphericalBlock block{.channel = channel, .incidenceDeg = 30};
        block.azimuthDeg = {0, 90, 180, 270, 360};
        block.thetaDeg = {0, 45, 90};
        block.f.assign(15, 1 + static_cast<double>(channel));
        table.blocks.push_back(block);
    }
    table.blocks[1].f[table.blocks[1].index(1, 1)] = kNan;
    const BrdfRows rows = rowsOf(table);
    EXPECT_EQ(rows.pairs.size(), 5U);  // the pole, and four of 45 degrees
    EXPECT_EQ(rows.f[rows.index(0, 2)], 3);
    std::size_t missing = 0;
    for (const double f : rows.f) missing += std::isnan(f) ? 1U : 0U;
    EXPECT_EQ(missing, 1U);
    table.blocks[2].incidenceDeg = 50;
    EXPECT_EQ(rowsOf(table).pairs.size(), 10U);
}

/// Two lights, two sides and three channels, in the order that `less` asks for.
template <class Less>
SphericalTable inOrder(Less less) {
    SphericalTable table;
    table.channels = Channel::ofBands();
    for (const double incidence : {0.0, 40.0}) {
        for (const bool transmission : {false, true}) {
            for (std::size_t channel = 0; channel < 3; ++channel) {
                SphericalBlock block{
                    .channel = channel, .incidenceDeg = incidence, .transmission = transmission};
                block.azimuthDeg = {0, 120, 240};
                block.thetaDeg =
                    transmission ? std::vector<double>{120, 180} : std::vector<double>{0, 45};
                for (std::size_t i = 0; i < 6; ++i) {
                    block.f.push_back(static_cast<double>(10 * channel + i) + incidence);
                }
                table.blocks.push_back(block);
            }
        }
    }
    std::stable_sort(table.blocks.begin(), table.blocks.end(), less);
    return table;
}

TEST(RowsOf, AreTheSameWhicheverOfItsBlocksAFileHasOutermost) {
    const auto asMade = [](const SphericalBlock&, const SphericalBlock&) { return false; };
    const auto byChannel = [](const SphericalBlock& a, const SphericalBlock& b) {
        return a.channel < b.channel;
    };
    const BrdfRows innermost = rowsOf(inOrder(asMade));
    const BrdfRows outermost = rowsOf(inOrder(byChannel));
    EXPECT_EQ(innermost.pairs.size(), 2U * 2 * 4);  // lights, sides, the pole and three of a ring
    for (const double f : innermost.f) EXPECT_FALSE(std::isnan(f));
    ASSERT_EQ(outermost.pairs.size(), innermost.pairs.size());
    EXPECT_EQ(outermost.f, innermost.f);
    for (std::size_t i = 0; i < innermost.pairs.size(); ++i) {
        EXPECT_EQ(outermost.pairs[i].in.vector(), innermost.pairs[i].in.vector()) << i;
        EXPECT_EQ(outermost.pairs[i].out.vector(), innermost.pairs[i].out.vector()) << i;
    }
}

TEST(RowsOf, KeepEachOfTheBlocksThatAFileRepeats) {
    SphericalTable table =
        inOrder([](const SphericalBlock&, const SphericalBlock&) { return false; });
    const std::size_t once = rowsOf(table).pairs.size();
    table.blocks.push_back(table.blocks.front());
    EXPECT_EQ(rowsOf(table).pairs.size(), once + 4);
}

}  // namespace
}  // namespace gonio::proc
