#include "proc/export/half_difference_fill.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "proc/formats/merl.h"
#include "proc/models/spec.h"
#include "proc/table/half_difference_lookup.h"
#include "tests/support/asymmetric_lobe.h"
#include "tests/support/random_directions.h"

namespace gonio::proc {
namespace {

HalfDifferenceTable smallGrid() {
    HalfDifferenceTable grid;
    grid.thetaHalfCount = 30;
    grid.thetaDiffCount = 30;
    grid.phiDiffCount = 60;
    return grid;
}

/// Through the bytes of a file.
HalfDifferenceLookup throughFile(const HalfDifferenceTable& table) {
    auto read = parseMerl(writeMerl(table).bytes, "t.binary");
    EXPECT_TRUE(read) << (read ? "" : read.error().message);
    auto lookup = HalfDifferenceLookup::over(std::move(read->content));
    EXPECT_TRUE(lookup);
    return std::move(*lookup);
}

TEST(HalfDifferenceFill, GivesAGgxBackAtItsNodesThroughAFile) {
    const auto model = makeModel("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.3,f0=0.5");
    ASSERT_TRUE(model);
    const FilledHalfDifference filled = fillHalfDifference(**model, smallGrid());
    EXPECT_EQ(filled.unanswered, 0U);
    EXPECT_EQ(filled.uncertain, 0U);
    const HalfDifferenceLookup back = throughFile(filled.table);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < filled.table.nodeCount(); ++i) {
        const LightView pair = filled.table.pairAt(filled.table.nodeAt(i));
        if (!aboveHorizon(pair)) {
            EXPECT_TRUE(std::isnan(back.table().planes[0][i]));
            continue;
        }
        ++compared;
        const LedBands f = (*model)->answer(pair).f;
        for (const Band band : kBands) {
            ASSERT_NEAR(back.table().planes[index(band)][i], f[band], 1e-12 * f[band]);
        }
        const Answer answer = back.answer(pair);
        ASSERT_TRUE(answer.present()) << i;
        ASSERT_NEAR(answer.f[Band::G], f[Band::G], 1e-6 * f[Band::G]) << i;
    }
    EXPECT_EQ(compared, filled.nodes);
    EXPECT_GT(compared, filled.table.nodeCount() / 4);
}

TEST(HalfDifferenceFill, HoldsALambertianEverywhere) {
    const auto model = makeModel("lambert,albedo=0.5");
    ASSERT_TRUE(model);
    const HalfDifferenceLookup back = throughFile(fillHalfDifference(**model, smallGrid()).table);
    std::mt19937_64 random(7);
    std::size_t answered = 0;
    for (int i = 0; i < 2000; ++i) {
        const LightView pair{test::randomDirection(random), test::randomDirection(random)};
        const Answer answer = back.answer(pair);
        if (!answer.present()) continue;
        ++answered;
        ASSERT_NEAR(answer.f[Band::R], 0.5 / kPi, 1e-12);
    }
    EXPECT_GT(answered, 1500U);
}

TEST(HalfDifferenceFill, KeepsTheSideOfALobeWhereTheCircleIsWhole) {
    // Half a circle takes a reciprocal BRDF for granted, which the lobe is not.
    HalfDifferenceTable grid;
    grid.thetaHalfCount = 45;
    grid.thetaDiffCount = 45;
    grid.phiDiffCount = 360;
    grid.wholeCircle = true;
    const test::AsymmetricLobe lobe;
    const HalfDifferenceLookup back = throughFile(fillHalfDifference(lobe, grid).table);
    EXPECT_TRUE(back.table().wholeCircle);
    for (const double incidence : {20.0, 40.0, 60.0}) {
        const Direction wi =
            Direction::fromSpherical(Radians::fromDegrees(incidence), Radians::fromDegrees(30));
        const Direction left = test::AsymmetricLobe::lobeOf(wi);
        const Direction right = Direction::fromSpherical(45_deg, 30_deg + 140_deg);
        const double there = lobe.answer({wi, left}).f[Band::R];
        EXPECT_NEAR(back.answer({wi, left}).f[Band::R], there, 0.02 * there);
        EXPECT_LT(back.answer({wi, right}).f[Band::R], 0.8 * there);
    }
}

TEST(HalfDifferenceFill, KeepsTheMirrorDirectionOfANarrowLobe) {
    const auto model = makeModel("ggx,alpha=0.05,f0=0.9");
    ASSERT_TRUE(model);
    HalfDifferenceTable grid;
    grid.phiDiffCount = 36;
    const HalfDifferenceLookup back = throughFile(fillHalfDifference(**model, grid).table);
    for (const int incidence : {0, 20, 40, 60}) {
        const Direction wi =
            Direction::fromSpherical(Radians::fromDegrees(incidence), Radians::fromDegrees(50));
        double best = -1;
        int at = -1;
        for (int theta = -80; theta <= 80; ++theta) {
            const Direction wo = Direction::fromSpherical(Radians::fromDegrees(std::abs(theta)),
                                                          theta < 0 ? 50_deg : 230_deg);
            const double f = back.answer({wi, wo}).f[Band::R];
            if (f > best) {
                best = f;
                at = theta;
            }
        }
        EXPECT_NEAR(at, incidence, 1);
    }
}

}  // namespace
}  // namespace gonio::proc
