#include "proc/quality/verdict.h"

#include <gtest/gtest.h>

namespace gonio::proc {
namespace {

const Verdict kTilt{.name = "tilt",
                    .grade = Grade::Warned,
                    .figure = Figure{.value = 1.524, .u = 0.01, .unit = "degrees", .limit = 1},
                    .evidence = "the sample is tilted",
                    .next = "seat it again"};
const Verdict kUnknown{.name = "translucency",
                       .grade = Grade::NotDetermined,
                       .figure = {},
                       .evidence = "one backing alone",
                       .next = {}};

TEST(Verdict, ComesBackFromItsText) {
    const auto back = readVerdicts(verdictsText(std::vector{kTilt, kUnknown}));
    ASSERT_EQ(back.size(), 2U);
    EXPECT_EQ(back[0].name, "tilt");
    EXPECT_EQ(back[0].grade, Grade::Warned);
    ASSERT_TRUE(back[0].figure);
    EXPECT_EQ(back[0].figure->value, 1.524);
    EXPECT_EQ(back[0].figure->u, 0.01);
    EXPECT_EQ(back[0].figure->limit, 1);
    EXPECT_EQ(back[0].next, "seat it again");
    EXPECT_EQ(back[1].grade, Grade::NotDetermined);
    EXPECT_FALSE(back[1].figure);
    EXPECT_TRUE(back[1].next.empty());
    EXPECT_EQ(verdictsText(back), verdictsText(std::vector{kTilt, kUnknown}));
}

TEST(Verdict, IsOneReadableLine) {
    EXPECT_EQ(described(kTilt),
              "tilt: warned, 1.52 degrees (u 0.0100 degrees, limit 1.00 degrees): the sample is "
              "tilted; seat it again");
    EXPECT_EQ(described(kUnknown), "translucency: not determined: one backing alone");
    EXPECT_EQ(amount(0.0012345, "1"), "0.123 %");
}

TEST(Verdict, FreeTextOfOlderFilesIsKept) {
    EXPECT_TRUE(readVerdicts("").empty());
    const auto old = readVerdicts("tilt: 0.52 degrees (u 0.01 degrees), corrected");
    ASSERT_EQ(old.size(), 1U);
    EXPECT_EQ(old[0].name, "tilt");
    EXPECT_EQ(old[0].grade, Grade::NotDetermined);
    EXPECT_EQ(old[0].evidence, "0.52 degrees (u 0.01 degrees), corrected");
    EXPECT_EQ(readVerdicts("fine:").at(0).evidence, "");
    EXPECT_EQ(readVerdicts("anything").at(0).evidence, "anything");
    EXPECT_TRUE(readVerdicts("[1, null, \"x\"]").empty());
}

TEST(Verdict, IsGradedJustBelowAtAndAboveItsLimits) {
    const Limits limits{.warned = 1, .refused = 5};
    const auto grade = [&](double value) {
        Figure figure{.value = value, .u = {}, .unit = "1", .limit = 0};
        const Grade found = graded(figure, limits);
        EXPECT_EQ(figure.limit, found == Grade::Refused ? 5 : 1);
        return found;
    };
    EXPECT_EQ(grade(1), Grade::Ok);
    EXPECT_EQ(grade(1.0001), Grade::Warned);
    EXPECT_EQ(grade(5), Grade::Warned);
    EXPECT_EQ(grade(5.0001), Grade::Refused);
}

TEST(Verdict, TakesThePlaceOfTheOneOfItsName) {
    std::vector<Verdict> all{kTilt, kUnknown};
    Verdict again = kTilt;
    again.grade = Grade::Ok;
    put(all, again);
    put(all, {.name = "light", .figure = {}, .evidence = {}, .next = {}});
    ASSERT_EQ(all.size(), 3U);
    EXPECT_EQ(all[0].grade, Grade::Ok);
    EXPECT_EQ(all[2].name, "light");
}

}  // namespace
}  // namespace gonio::proc
