#include "proc/table/spherical_turn.h"

#include <gtest/gtest.h>

#include "tests/support/spherical_tables.h"

namespace gonio::proc {
namespace {

using test::sphericalTable;
using test::steps;

double handed(const LightView& pair, std::size_t) { return test::handedValue(pair); }

/// Every node holds the value of the direction that it now stands for.
void expectSameDirections(const SphericalTable& table, double mirrorSide = 1) {
    for (const SphericalBlock& block : table.blocks) {
        ASSERT_EQ(block.f.size(), block.azimuthDeg.size() * block.thetaDeg.size());
        for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
            for (std::size_t t = 0; t < block.thetaDeg.size(); ++t) {
                LightView pair = table.pairAt(block, a, t);
                if (mirrorSide < 0) {
                    pair.out = Direction::fromSpherical(pair.out.theta(), -pair.out.phi());
                }
                EXPECT_NEAR(block.f[block.index(a, t)], test::handedValue(pair), 1e-12);
            }
        }
    }
}

TEST(SphericalTurn, KeepsEveryDirection) {
    for (const double mirror : {0.0, 90.0, 180.0, 270.0, 5.0, 359.0}) {
        for (const auto& azimuths : {steps(0, 360, 10), steps(0, 350, 10), steps(20, 80, 10)}) {
            const SphericalTable table =
                withMirrorAt(sphericalTable({.azimuthDeg = azimuths}, handed), mirror);
            EXPECT_EQ(table.mirrorAzimuthDeg, mirror);
            expectSameDirections(table);
            for (const SphericalBlock& block : table.blocks) {
                EXPECT_TRUE(std::is_sorted(block.azimuthDeg.begin(), block.azimuthDeg.end()));
                EXPECT_GE(block.azimuthDeg.front(), 0);
                EXPECT_LE(block.azimuthDeg.back(), 360);
            }
        }
    }
}

TEST(SphericalTurn, KeepsACircleClosed) {
    const SphericalTable table =
        withMirrorAt(sphericalTable({.azimuthDeg = steps(0, 360, 10)}, handed), 270);
    EXPECT_EQ(table.blocks[0].azimuthDeg, steps(0, 360, 10));
    const SphericalTable back = withMirrorAt(table, 180);
    EXPECT_EQ(back.blocks[1].azimuthDeg, steps(0, 360, 10));
    expectSameDirections(back);
}

TEST(SphericalTurn, MirrorsAHalfThatWouldLeaveTheTurn) {
    const SphericalTable half = sphericalTable(
        {.mirrorAzimuthDeg = 0, .planeSymmetrical = true, .azimuthDeg = steps(0, 180, 10)}, handed);
    const SphericalTable turned = withMirrorAt(half, 270);
    EXPECT_EQ(turned.blocks[0].azimuthDeg, steps(90, 270, 10));
    expectSameDirections(turned, -1);
    const SphericalTable other = withMirrorAt(half, 180);
    EXPECT_EQ(other.blocks[0].azimuthDeg, steps(180, 360, 10));
    expectSameDirections(other);
}

TEST(SphericalTurn, LeavesATableAloneThatIsThereAlready) {
    const SphericalTable table = sphericalTable({.azimuthDeg = steps(-30, 330, 10)}, handed);
    EXPECT_EQ(withMirrorAt(table, 180).blocks[0].azimuthDeg, table.blocks[0].azimuthDeg);
}

TEST(SphericalTurn, UnfoldsWhatIsPlaneSymmetrical) {
    const auto even = [](const LightView& pair, std::size_t) {
        return test::mirrorLobe(pair, 30) + pair.out.z();
    };
    for (const double first : {0.0, 90.0, 180.0}) {
        const SphericalTable table =
            wholeCircle(sphericalTable({.mirrorAzimuthDeg = first,
                                        .planeSymmetrical = true,
                                        .azimuthDeg = steps(first, first + 180, 10)},
                                       even));
        EXPECT_FALSE(table.planeSymmetrical);
        for (const SphericalBlock& block : table.blocks) {
            EXPECT_EQ(block.azimuthDeg, steps(0, 360, 10));
            for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
                for (std::size_t t = 0; t < block.thetaDeg.size(); ++t) {
                    EXPECT_NEAR(
                        block.f[block.index(a, t)], even(table.pairAt(block, a, t), 0), 1e-12);
                }
            }
        }
    }
}

TEST(SphericalTurn, ClosesACircleOnlyWhereItIsCovered) {
    EXPECT_EQ(
        wholeCircle(sphericalTable({.azimuthDeg = steps(0, 350, 10)}, handed)).blocks[0].azimuthDeg,
        steps(0, 360, 10));
    EXPECT_EQ(
        wholeCircle(sphericalTable({.azimuthDeg = steps(0, 300, 10)}, handed)).blocks[0].azimuthDeg,
        steps(0, 300, 10));
    EXPECT_EQ(
        wholeCircle(sphericalTable({.azimuthDeg = steps(5, 355, 10)}, handed)).blocks[0].azimuthDeg,
        steps(5, 355, 10));
}

}  // namespace
}  // namespace gonio::proc
