#include "proc/table/neighbour_study.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gonio::proc {
namespace {

/// Each look at it takes a microsecond.
class CountingClock : public Clock {
public:
    [[nodiscard]] Nanoseconds now() const override { return Nanoseconds(1000 * ++looks_); }

private:
    mutable std::int64_t looks_ = 0;
};

TEST(NeighbourStudy, MeasuresEachSizeOnce) {
    const CountingClock clock;
    const NeighbourStudyOptions options{
        .sizes = {100, 1000, 3000}, .repeats = 3, .each = Seconds(1e-6)};
    std::vector<double> parts;
    const auto rows =
        studyNeighbours(Stopwatch(clock), options, [&](double part) { parts.push_back(part); });
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(parts, (std::vector<double>{1.0 / 3, 2.0 / 3, 1}));
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(rows[i].samples, options.sizes[i]);
        EXPECT_NEAR(rows[i].build.count(), 1e-6, 1e-12);
        EXPECT_NEAR(rows[i].query.count(), 1e-6 / 8, 1e-12);  // eight to a look
        EXPECT_NEAR(rows[i].bruteForce.count(), 1e-6 / 8, 1e-12);
        // The pair and its place, six doubles each, are the least that the tree holds.
        EXPECT_GE(rows[i].treeBytes, rows[i].samples * 2 * 6 * sizeof(double));
        EXPECT_GE(rows[i].sampleBytes, rows[i].samples * sizeof(ScatteredSample));
    }
}

TEST(NeighbourStudy, FindsTheExponentsOfPowers) {
    std::vector<NeighbourCost> rows;
    for (const double n : {1e3, 1e4, 1e5}) {
        rows.push_back({.samples = static_cast<std::size_t>(n),
                        .build = Seconds(1e-8 * std::pow(n, 1.1)),
                        .query = Seconds(1e-6 * std::pow(n, 0.2)),
                        .bruteForce = Seconds(1e-9 * n),
                        .treeBytes = static_cast<std::size_t>(n) * 120});
    }
    const auto growth = [&](const NeighbourValue& value) { return growthOf(rows, value); };
    EXPECT_NEAR(growth([](const auto& r) { return r.build.count(); }), 1.1, 1e-12);
    EXPECT_NEAR(growth([](const auto& r) { return r.query.count(); }), 0.2, 1e-12);
    EXPECT_NEAR(growth([](const auto& r) { return static_cast<double>(r.treeBytes); }), 1, 1e-12);
    EXPECT_TRUE(
        std::isnan(growthOf({rows.front()}, [](const auto& r) { return r.query.count(); })));
}

TEST(NeighbourStudy, DrawsPairsOfARigTheSameForTheSameSeed) {
    const auto samples = rigLikeSamples(2000, 9);
    const auto again = rigLikeSamples(2000, 9);
    double farthest = 0, steepest = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        EXPECT_EQ(samples[i].pair.out.vector(), again[i].pair.out.vector());
        farthest = std::max(farthest, samples[i].pair.in.theta().degrees());
        steepest = std::max(steepest, samples[i].pair.out.theta().degrees());
    }
    EXPECT_GT(farthest, 68);
    EXPECT_LE(farthest, 70);
    EXPECT_GT(steepest, 74);
    EXPECT_LE(steepest, 75);
}

TEST(NeighbourStudy, WritesARowForEachSize) {
    EXPECT_EQ(neighbourCsv({{.samples = 10,
                             .build = Seconds(0.5),
                             .query = Seconds(1e-6),
                             .bruteForce = Seconds(2e-6),
                             .treeBytes = 30,
                             .sampleBytes = 40}}),
              "samples,build_seconds,query_seconds,brute_force_seconds,tree_bytes,sample_bytes\n"
              "10,0.5,1e-06,2e-06,30,40\n");
}

}  // namespace
}  // namespace gonio::proc
