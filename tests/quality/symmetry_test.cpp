#include "proc/quality/symmetry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/table/merged_info.h"
#include "proc/table/rotations.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

/// One LED whose sides of the plane of incidence differ by `skew`, known to 1 % and what is common.
SampleSet skewed(double skew, double rotationDeg = 0) {
    SampleSet set;
    set.info.budgetJson =
        R"([{"led":0,"band":"r","components":[{"name":"white","type":"B","correlation":"common",)"
        R"("median_relative":0.02}]}])";
    set.leds = {test::ledTable(20_deg, [&](Radians, const Direction& wo) {
        return wo.y() > 0 ? 1 + skew / 2 : 1 - skew / 2;
    })};
    set.leds[0].bands[1] = set.leds[0].bands[2] = {};
    turnTo(set, rotationOf(rotationDeg));
    return set;
}

SampleSet both(const SampleSet& one, const SampleSet& other) {
    const std::vector<SampleSet> parts{one, other};
    SampleSet set = one;
    set.leds.push_back(other.leds[0]);
    set.info.budgetJson = joinedBudget(parts);
    return set;
}

TEST(SymmetryVerdicts, WarnWhereTheDifferenceIsLargeAndMoreThanChance) {
    EXPECT_EQ(planeVerdict(skewed(0)).grade, Grade::Ok);
    EXPECT_EQ(planeVerdict({}).grade, Grade::NotDetermined);
    // The rms deviation of two values from their mean is 1 / sqrt(2) of their difference; with 1 %
    // of u each, chi-square is 4 at a difference of 2.83 %.
    const Verdict large = planeVerdict(skewed(0.04));
    EXPECT_EQ(large.grade, Grade::Warned) << described(large);
    EXPECT_NEAR(large.figure->value, 0.04 / std::sqrt(2.0), 1e-3);
    EXPECT_NE(large.evidence.find("rms from their mean"), std::string::npos) << large.evidence;
    EXPECT_FALSE(large.next.empty());
    EXPECT_EQ(planeVerdict(skewed(0.0282)).grade, Grade::Ok);      // chi-square 3.98, 1.99 %
    EXPECT_EQ(planeVerdict(skewed(0.0286)).grade, Grade::Warned);  // 4.09, 2.02 %
    QualityLimits wide;
    wide.planeSymmetry = 0.05;
    EXPECT_EQ(planeVerdict(skewed(0.04), wide).grade, Grade::Ok);
    // The rotation that is worst counts, however many are good.
    SampleSet two = both(skewed(0), skewed(0.04, 45));
    EXPECT_EQ(planeVerdict(two).grade, Grade::Warned);

    EXPECT_EQ(isotropyVerdict(skewed(0)).grade, Grade::NotDetermined);
    EXPECT_EQ(isotropyVerdict(two).grade, Grade::Ok) << "one side up, the other down by 2 %";
    two = both(skewed(0), skewed(0.2, 45));
    EXPECT_EQ(isotropyVerdict(two).grade, Grade::Warned);
}

TEST(SymmetryVerdicts, RepeatsAreJudgedByTheirOutliersAndTheirLight) {
    EXPECT_EQ(repeatsVerdict(Averaged{}).grade, Grade::NotDetermined);
    Averaged repeats;
    repeats.cells.freedom = 50'000;
    repeats.cells.values = 100'000;
    repeats.cells.outliers = 10;
    EXPECT_EQ(repeatsVerdict(repeats).grade, Grade::Ok);
    repeats.cells.outliers = 11;
    EXPECT_EQ(repeatsVerdict(repeats).grade, Grade::Warned);
    EXPECT_NE(repeatsVerdict(repeats).evidence.find("11 of 100000 values"), std::string::npos);
    repeats.cells.outliers = 0;
    repeats.scales.outliers = 1;
    EXPECT_EQ(repeatsVerdict(repeats).grade, Grade::Warned);
    EXPECT_NE(repeatsVerdict(repeats).evidence.find("light of 1"), std::string::npos);
}

}  // namespace
}  // namespace gonio::proc
