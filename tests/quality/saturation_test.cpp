#include "proc/quality/saturation.h"

#include <gtest/gtest.h>

#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

SampleSet grey() {
    return test::sampleSet([](Radians /*incidence*/, const Direction& /*wo*/) { return 0.1; });
}

void saturate(CellSamples& cells, std::size_t cell) {
    cells.flags[cell] = Flags{Flag::Saturated};
    cells.f[cell] = std::nan("");
}

TEST(Saturation, WithoutALostCellIsFine) {
    const Verdict verdict = saturationVerdict(grey());
    EXPECT_EQ(verdict.grade, Grade::Ok);
    ASSERT_TRUE(verdict.figure);
    EXPECT_EQ(verdict.figure->value, 0);
}

TEST(Saturation, OneLostCellIsWarnedOf) {
    SampleSet sample = grey();
    saturate(sample.leds[2].bands[1], 500);
    const Verdict verdict = saturationVerdict(sample);
    EXPECT_EQ(verdict.grade, Grade::Warned);
    EXPECT_NE(verdict.evidence.find("LED 2 g"), std::string::npos) << verdict.evidence;
}

TEST(Saturation, MoreThanFivePerCentOfTheDiscIsRefused) {
    // The disc to 75 degrees is 1 - cos(75 deg) of a hemisphere; up to 16 degrees lie 5.2 % of it.
    for (const auto& [rows, grade] :
         {std::pair(15, Grade::Warned), std::pair(16, Grade::Refused)}) {
        SampleSet sample = grey();
        CellSamples& cells = sample.leds[0].bands[0];
        for (std::size_t cell = 0; cell < cells.size(); ++cell) {
            if (CellGrid::place(cell).row < rows) saturate(cells, cell);
        }
        const double radians = rows * kPi / 180;
        const double share = (1 - std::cos(radians)) / (1 - std::cos(75 * kPi / 180));
        EXPECT_NEAR(saturatedShare(cells), share, 1e-9);
        EXPECT_EQ(saturationVerdict(sample).grade, grade) << rows;
    }
}

}  // namespace
}  // namespace gonio::proc
