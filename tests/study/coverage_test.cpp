// The guard of the coverage report: the same code, fewer repeats and a shorter strip. In ./check
// --nightly the report itself, whose table goes to $GONIO_COVERAGE_REPORT (a folder) when that is
// set.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "tests/study/coverage_repeat.h"

namespace gonio::study {
namespace {

/// A tenth of what a repeat of the report looks at: the mirror direction of 20 degrees.
constexpr sim::View kShortStrip{.x = 464, .y = 496, .size = {96, 32}};
constexpr std::uint64_t kRepeats = 60;

TEST(BinomialLow, IsTheQuantileOfTheBinomial) {
    EXPECT_EQ(binomialLow(1, 0.5, 0.6), 1);    // P(0) = 0.5
    EXPECT_EQ(binomialLow(10, 0.5, 2e-2), 2);  // P(<= 1) = 0.0107, P(<= 2) = 0.055
    EXPECT_EQ(binomialLow(10, 0.5, 1e-2), 1);  // P(0) = 0.00098
}

/// Cells of one repeat may all be off together: a row is then worth as many trials as it has
/// repeats, and no coverage of 95 % falls below this by chance more than once in 1e6 runs of all
/// rows.
TEST(Coverage, HoldsTheTruthOverAFewRepeats) {
    const CoverageRows rows = CoverageStudy(kShortStrip).run(1'000'000, kRepeats);
    double alone = 0;
    int seen = 0;
    for (const Row& row : rows.rows()) {
        if (row.repeats.size() < kRepeats) continue;
        ++seen;
        const int n = static_cast<int>(row.repeats.size());
        EXPECT_GE(row.coverage(), binomialLow(n, 0.95, 1e-7) / double{kRepeats})
            << row.name() << (row.flank ? " flank" : " even");
        alone += row.coverageRandom();
    }
    EXPECT_GE(seen, 7);
    // Without what is systematic the intervals are far too short.
    EXPECT_LT(alone / seen, 0.7);
    std::cout << rows.markdown();
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSlow = true;
#else
constexpr bool kSlow = false;
#endif

/// To three standard errors.
TEST(CoverageReport, IsWithin94To96PerCent) {
    if (std::getenv("GONIO_NIGHTLY") == nullptr || kSlow) GTEST_SKIP() << "a nightly study";
    constexpr std::uint64_t kReported = 4400;
    const CoverageRows rows = CoverageStudy(kStrip).run(0, kReported);
    for (const Row& row : rows.rows()) {
        if (row.repeats.empty()) continue;
        const std::string where = row.name() + (row.flank ? " flank" : " even");
        const double margin = 3 * row.standardError();
        EXPECT_GE(row.repeats.size(), 4300U) << where;
        EXPECT_GE(row.coverage() + margin, 0.94) << where;
        EXPECT_LE(row.coverage() - margin, 0.96) << where;
    }
    std::cout << rows.markdown();
    if (const char* folder = std::getenv("GONIO_COVERAGE_REPORT")) {
        std::ofstream(std::filesystem::path(folder) / "coverage.md") << rows.markdown();
        std::ofstream(std::filesystem::path(folder) / "coverage.csv") << rows.csv();
    }
}

}  // namespace
}  // namespace gonio::study
