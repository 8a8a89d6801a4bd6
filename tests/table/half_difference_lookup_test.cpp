#include "proc/table/half_difference_lookup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "proc/core/coordinates.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

HalfDifferenceTable smallTable() {
    HalfDifferenceTable table;
    table.thetaHalfCount = 9;
    table.thetaDiffCount = 9;
    table.phiDiffCount = 18;
    for (std::size_t band = 0; band < 3; ++band) {
        for (std::size_t i = 0; i < table.nodeCount(); ++i) {
            const HalfDifferenceNode n = table.nodeAt(i);
            table.planes[band].push_back(static_cast<double>(n.thetaHalf) +
                                         10 * static_cast<double>(band) +
                                         static_cast<double>(n.thetaDiff) / 100);
        }
    }
    return table;
}

HalfDifferenceLookup lookup(HalfDifferenceTable table) {
    auto made = HalfDifferenceLookup::over(std::move(table));
    EXPECT_TRUE(made);
    return std::move(*made);
}

LightView pairOf(double thetaHalf, double thetaDiff, double phiDiff, double phiHalf = 0) {
    return fromHalfDifference({Radians::fromDegrees(thetaHalf),
                               Radians::fromDegrees(phiHalf),
                               Radians::fromDegrees(thetaDiff),
                               Radians::fromDegrees(phiDiff)});
}

TEST(HalfDifferenceTable, CountsItsNodesInOrder) {
    const HalfDifferenceTable table = smallTable();
    for (std::size_t i = 0; i < table.nodeCount(); ++i) EXPECT_EQ(table.index(table.nodeAt(i)), i);
}

TEST(HalfDifferenceLookup, AnswersItsOwnNumbersAtNodes) {
    const HalfDifferenceLookup at = lookup(smallTable());
    const HalfDifferenceTable& table = at.table();
    for (std::size_t i = 0; i < table.nodeCount(); ++i) {
        const HalfDifferenceNode node = table.nodeAt(i);
        const LightView pair = table.pairAt(node);
        if (!aboveHorizon(pair)) continue;
        const Answer answer = at.answer(pair);
        ASSERT_NEAR(answer.f[Band::B], table.planes[2][i], 1e-6) << i;
        // The pole of theta_half loses phi_diff to rounding: only there a node may not be seen.
        if (node.thetaHalf > 0) {
            ASSERT_TRUE(answer.flags.has(Flag::Measured)) << i;
        }
    }
}

TEST(HalfDifferenceLookup, IsLinearInTheRootOfThetaHalf) {
    const HalfDifferenceLookup at = lookup(smallTable());
    const double share = 3.25;
    const Answer answer = at.answer(pairOf(90 * (share / 9) * (share / 9), 25, 95, 77));
    EXPECT_NEAR(answer.f[Band::R], 3.25 + 2.5 / 100, 1e-9);
    EXPECT_EQ(answer.source, Source::Interpolated);
}

TEST(HalfDifferenceLookup, GoesRoundAt180DegreesByReciprocity) {
    HalfDifferenceTable table = smallTable();
    for (std::size_t i = 0; i < table.nodeCount(); ++i) {
        const std::size_t p = table.nodeAt(i).phiDiff;
        table.planes[0][i] = p == 0 ? 1 : p == 17 ? 2 : 0;
    }
    const HalfDifferenceLookup at = lookup(table);
    EXPECT_NEAR(at.answer(pairOf(10, 20, 172.5)).f[Band::R], 1.75, 1e-9);
    EXPECT_NEAR(at.answer(pairOf(10, 20, 177.5)).f[Band::R], 1.25, 1e-9);
    EXPECT_NEAR(at.answer(pairOf(10, 20, 357.5)).f[Band::R], 1.25, 1e-9);
    EXPECT_NEAR(at.answer(pairOf(10, 20, 182.5)).f[Band::R], 0.75, 1e-9);
}

TEST(HalfDifferenceLookup, DoesNotTurnAWholeCircleByReciprocity) {
    HalfDifferenceTable table = smallTable();
    table.wholeCircle = true;  // nodes every 20 degrees
    for (std::size_t i = 0; i < table.nodeCount(); ++i) {
        table.planes[0][i] = static_cast<double>(table.nodeAt(i).phiDiff);
    }
    const HalfDifferenceLookup at = lookup(table);
    EXPECT_NEAR(at.answer(pairOf(10, 20, 30)).f[Band::R], 1.5, 1e-9);
    EXPECT_NEAR(at.answer(pairOf(10, 20, 210)).f[Band::R], 10.5, 1e-9);
    EXPECT_NEAR(at.answer(pairOf(10, 20, 350)).f[Band::R], 8.5, 1e-9);
}

TEST(HalfDifferenceLookup, DoesNotAnswerWhereANodeIsMissing) {
    HalfDifferenceTable table = smallTable();
    table.planes[1][table.index({3, 2, 4})] = kNan;
    const HalfDifferenceLookup at = lookup(table);
    const double node = 90 * (3.0 / 9) * (3.0 / 9);
    EXPECT_FALSE(at.answer(pairOf(node, 20, 40)).present());
    EXPECT_FALSE(at.answer(pairOf(node + 0.5, 21, 41)).present());
    EXPECT_TRUE(at.answer(pairOf(node, 20, 51)).present());
    EXPECT_TRUE(at.answer(pairOf(node, 20, 50)).present());
}

TEST(HalfDifferenceLookup, ExtrapolatesBeyondTheLastNode) {
    const HalfDifferenceLookup at = lookup(smallTable());
    const Answer answer = at.answer(pairOf(1, 85, 40));
    EXPECT_TRUE(answer.flags.has(Flag::Extrapolated));
    EXPECT_EQ(answer.source, Source::Extrapolated);
}

TEST(HalfDifferenceLookup, SaysBelowHorizon) {
    const HalfDifferenceLookup at = lookup(smallTable());
    const Direction down = Direction::fromSpherical(100_deg, 0_deg);
    EXPECT_TRUE(at.answer({Direction(), down}).flags.has(Flag::BelowHorizon));
    EXPECT_FALSE(at.answer({Direction(), down}).present());
    EXPECT_TRUE(at.answer({Direction(), Direction()}).present());  // wi = wo = n
}

TEST(HalfDifferenceLookup, RefusesPlanesOfAnotherSize) {
    HalfDifferenceTable table = smallTable();
    table.planes[2].pop_back();
    EXPECT_FALSE(HalfDifferenceLookup::over(table));
    EXPECT_FALSE(HalfDifferenceLookup::over(HalfDifferenceTable{}));
}

}  // namespace
}  // namespace gonio::proc
