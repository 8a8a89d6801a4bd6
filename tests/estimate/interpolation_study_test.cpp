#include "proc/estimate/interpolation_study.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "proc/estimate/interpolation_table.h"

namespace gonio::proc {
namespace {

/// Its answers take two microseconds each, on the clock that it is.
class Slow final : public Scatterer, public Clock {
public:
    [[nodiscard]] Answer answer(const LightView& /*pair*/) const override {
        now_ += 2000;
        return {};
    }
    [[nodiscard]] Nanoseconds now() const override { return Nanoseconds(now_.load()); }

private:
    mutable std::atomic<std::int64_t> now_{0};
};

TEST(InterpolationStudy, TimesTheAnswersOfTheAskedPairsAlone) {
    const Asked asked{.incidences = {10_deg, 30_deg}, .firstRow = 10, .lastRow = 20, .stride = 7};
    const auto pairs = askedPairs(asked);
    ASSERT_GT(pairs.size(), 100U);
    const double first = pairs.front().out.theta().degrees();
    EXPECT_TRUE(first > 10 && first < 11) << first;
    EXPECT_NEAR(pairs.back().in.theta().degrees(), 30, 1e-9);
    const Slow slow;
    EXPECT_NEAR(microsecondsPerAnswer(slow, pairs, slow), 2, 1e-12);
    EXPECT_EQ(microsecondsPerAnswer(slow, {}, slow), 0);
    // What a pass of errors asks is these pairs.
    const Slow counted;
    (void)errorOf(counted, Slow(), asked);
    EXPECT_EQ(counted.now().count(), static_cast<std::int64_t>(2000 * pairs.size()));
}

TEST(InterpolationTable, SaysOfHowManyMaterialsASummaryIs) {
    const auto row = [](const std::string& material, double error) {
        return InterpolationRow{.method = "prior",
                                .material = material,
                                .chosen = {},
                                .errors = {{.hemisphere = error, .lobe = error}}};
    };
    const std::vector<InterpolationRow> rows{
        row("a", 0.1), row("b", 0.3), row("c", std::nan("")), row("d", 0.2)};
    const auto summary = summaryOf(rows, "prior", false, 0, RegionPart::Hemisphere);
    EXPECT_EQ(summary.answered, 3U);
    EXPECT_EQ(summary.materials, 4U);
    EXPECT_DOUBLE_EQ(summary.median, 0.2);
    EXPECT_DOUBLE_EQ(summary.worst, 0.3);
    const auto none = summaryOf(rows, "auto", false, 0, RegionPart::Hemisphere);
    EXPECT_EQ(none.answered, 0U);
    EXPECT_TRUE(std::isnan(none.median));
}

}  // namespace
}  // namespace gonio::proc
