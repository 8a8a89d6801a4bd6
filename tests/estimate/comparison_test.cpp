#include "proc/estimate/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/models/spec.h"
#include "proc/table/sample_lookup.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

std::unique_ptr<const AnalyticModel> lambert(const std::string& albedo) {
    return std::move(*makeModel("lambert,albedo=" + albedo));
}

/// f = scale / pi with u_random 1 % and u_systematic 2 %.
SampleLookup tile(double scale) {
    return SampleLookup(test::sampleSet([&](Radians, const Direction&) { return scale / kPi; }));
}

TEST(CompareSurfaces, FindsAKnownRatioInEveryMeasure) {
    const auto rows = compareSurfaces(*lambert("0.33"), *lambert("0.3"), {0_deg, 40_deg});
    ASSERT_EQ(rows.size(), 2U * 4 * 3);
    for (const Difference& row : rows) {
        EXPECT_NEAR(row.relativeRms, 0.1, 1e-12);
        EXPECT_NEAR(row.relativeMean, 0.1, 1e-12);
        EXPECT_NEAR(row.logRms, std::log(1.1), 1e-12);
        EXPECT_NEAR(row.cosineRms, 0.1, 1e-12);
        EXPECT_TRUE(std::isnan(row.within2u));
        EXPECT_EQ(row.oneOnly, 0U);
    }
    EXPECT_EQ(agreementOf(rows), Agreement::Unknown);
}

TEST(CompareSurfaces, AgreesWithinTheUncertaintiesAndNotBeyond) {
    // Combined u of two such tiles: sqrt(2) hypot(1, 2) % = 3.2 % in R, a third of it in B.
    EXPECT_EQ(agreementOf(compareSurfaces(tile(0.3), tile(0.304), {20_deg})), Agreement::Agree);
    EXPECT_EQ(agreementOf(compareSurfaces(tile(0.3), tile(0.33), {20_deg})), Agreement::Disagree);
}

/// The same f everywhere, with u in one direction alone.
class Rarely final : public Scatterer {
public:
    explicit Rarely(double statedToDeg) : statedToDeg_(statedToDeg) {}
    [[nodiscard]] Answer answer(const LightView& pair) const override {
        Answer answer;
        answer.f = LedBands::all(0.1);
        if (pair.out.theta().degrees() < statedToDeg_) answer.uRandom = LedBands::all(0.01);
        return answer;
    }

private:
    double statedToDeg_;
};

TEST(CompareSurfaces, SaysNothingOfFewStatedValuesAndCountsThem) {
    // 30 degrees are 13 % of the hemisphere, 80 are 83 %.
    const auto few = compareSurfaces(Rarely(30), *lambert("0.31416"), {20_deg});
    EXPECT_GT(few.front().stated, 0U);
    EXPECT_LT(few.front().stated, few.front().values / 4);
    EXPECT_EQ(few.front().within2u, 1);
    EXPECT_EQ(agreementOf(few), Agreement::Unknown);
    EXPECT_EQ(agreementOf(compareSurfaces(Rarely(80), *lambert("0.31416"), {20_deg})),
              Agreement::Agree);
}

TEST(CompareSurfaces, LeavesZerosOutOfARatioAltogether) {
    /// 0.1 on one side of the plane of incidence, 0 on the other.
    class Half final : public Scatterer {
        [[nodiscard]] Answer answer(const LightView& pair) const override {
            Answer answer;
            answer.f = LedBands::all(pair.out.y() > 0 ? 0.1 : 0);
            return answer;
        }
    };
    const auto rows = compareSurfaces(*lambert("0.628319"), Half(), {20_deg});
    EXPECT_NEAR(rows.front().relativeRms, 1, 1e-5);  // 0.2 against 0.1
    EXPECT_TRUE(
        std::isnan(compareSurfaces(*lambert("0.3"), *lambert("0"), {20_deg}).front().relativeRms));
}

TEST(CompareSurfaces, CountsWhereOnlyOneAnswers) {
    const auto rows = compareSurfaces(tile(0.3), *lambert("0.3/0.6/0.9"), {20_deg});
    EXPECT_GT(rows.front().oneOnly, 4000U);  // beyond 75 degrees
    EXPECT_NEAR(rows.front().relativeRms, 0, 1e-12);
}

TEST(CompareSurfaces, SaysNothingWhereNothingIsCommon) {
    EXPECT_TRUE(compareSurfaces(tile(0.3), *lambert("0.3"), {80_deg}).empty());
    EXPECT_EQ(agreementOf({}), Agreement::Unknown);
}

}  // namespace
}  // namespace gonio::proc
