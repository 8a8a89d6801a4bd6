#include "proc/estimate/lookup_study.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gonio::proc {
namespace {

/// A microsecond a look.
class TickingClock : public Clock {
public:
    [[nodiscard]] Nanoseconds now() const override { return Nanoseconds(1000 * ++ticks_); }

private:
    mutable std::int64_t ticks_ = 0;
};

LookupRow row(double worst, std::size_t bytes, double ns, const std::string& material = "m") {
    LookupRow made;
    made.material = material;
    made.cosine.worst = worst;
    made.bytes = bytes;
    made.scalarNs = ns;
    return made;
}

TEST(LookupStudy, HoldsBakedTablesAgainstTheMerlLayoutOfTheSameRun) {
    LookupSweep sweep = LookupSweep::quick();
    sweep.materials.resize(1);
    sweep.resolutions = {{16, 8, 4}, {64, 32, 16}};
    sweep.pairs = 2000;
    const TickingClock clock;
    std::size_t told = 0, all = 0;
    const auto rows =
        lookupStudy(sweep, Stopwatch(clock), [&](std::size_t done, std::size_t steps) {
            EXPECT_EQ(done, told++);
            all = steps;
        });
    ASSERT_TRUE(rows);
    EXPECT_EQ(rows->size(), 10U);  // 2 resolutions x 2 storages x 2 carriers, and 2 of MERL
    EXPECT_EQ(told, all);
    int knees = 0;
    double best = 1, merl = 1;
    for (const LookupRow& one : *rows) {
        knees += one.knee ? 1 : 0;
        // A tick for 2000 pairs.
        EXPECT_NEAR(one.scalarNs, 0.5, 1e-9);
        EXPECT_GE(one.cosine.worst, one.cosine.p99);
        EXPECT_GE(one.cosine.p99, 0);
        const bool ofMerl = one.method.starts_with("MERL");
        EXPECT_EQ(std::isnan(one.drawNs), ofMerl);
        if (!ofMerl) {
            EXPECT_LT(one.draws, one.drawsByCosine);
        }
        (ofMerl ? merl : best) = std::min(ofMerl ? merl : best, one.worst());
    }
    EXPECT_EQ(knees, 1);
    EXPECT_LT(best, 0.01);
    EXPECT_LT(best, merl);
}

TEST(LookupStudy, ReportsASpecThatNoModelUnderstands) {
    LookupSweep sweep = LookupSweep::quick();
    sweep.materials = {{"bad", "lambert,albedo=0.3", "banana"}};
    sweep.merl = false;
    const TickingClock clock;
    const auto rows = lookupStudy(sweep, Stopwatch(clock));
    ASSERT_FALSE(rows);
    EXPECT_EQ(rows.error().kind, ErrorKind::Usage);
}

TEST(LookupFront, KeepsWhatNothingBeatsAndNamesItsKnee) {
    std::vector<LookupRow> rows{row(0.1, 100, 50),
                                row(0.01, 200, 51),
                                row(0.009, 10000, 52),
                                row(0.02, 300, 50),  // worse and heavier than the second
                                row(0.5, 50, 90, "other")};
    markFront(rows);
    EXPECT_TRUE(rows[0].onFront && rows[1].onFront && rows[2].onFront);
    EXPECT_FALSE(rows[3].onFront);
    EXPECT_TRUE(rows[1].knee);
    EXPECT_FALSE(rows[0].knee || rows[2].knee || rows[3].knee);
    EXPECT_TRUE(rows[4].onFront && rows[4].knee) << "a front of its own";
}

TEST(LookupFront, TakesTimesWithinATenthForEqual) {
    std::vector<LookupRow> rows{row(0.01, 100, 54), row(0.02, 100, 50), row(0.02, 100, 30)};
    markFront(rows);
    EXPECT_TRUE(rows[0].onFront);
    EXPECT_FALSE(rows[1].onFront) << "less exact, and hardly faster";
    EXPECT_TRUE(rows[2].onFront) << "less exact, but much faster";
}

TEST(LookupFront, MarkdownHasARowEach) {
    std::vector<LookupRow> rows{row(0.1, 2048, 50)};
    rows[0].batchNs = std::nan("");
    markFront(rows);
    const std::string text = markdown(rows);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
    EXPECT_NE(text.find("| 2 | 10.00 |"), std::string::npos) << text;
    EXPECT_NE(text.find("| 50.0 |  |"), std::string::npos) << text;
    EXPECT_NE(text.find("| knee |"), std::string::npos);
}

}  // namespace
}  // namespace gonio::proc
