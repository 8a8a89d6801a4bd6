#include "proc/quality/energy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

/// A white whose reflectance into the field is `share`; in R, and none in G and B.
SampleSet white(double share) {
    const double field = std::pow(std::sin(75 * kPi / 180), 2);
    SampleSet set = test::sampleSet(
        [&](Radians /*incidence*/, const Direction& /*wo*/) { return share / (kPi * field); });
    for (LedTable& led : set.leds) led.bands[1] = led.bands[2] = {};
    return set;
}

TEST(Energy, OfALambertianIsItsAlbedoTimesTheFieldsShare) {
    const auto fraction = reflectedFraction(white(0.6).leds[0].bands[0]);
    ASSERT_TRUE(fraction);
    // The cells' centres stand for one degree: 1 - (pi / 180)^2 / 24 of it, and less.
    EXPECT_NEAR(fraction->value, 0.6, 2e-4);
    // 2 % is one error of all cells, 1 % is each cell's own: of 15,000 alike it is 5e-5.
    EXPECT_NEAR(fraction->uSystematic, 0.02 * fraction->value, 1e-9);
    EXPECT_NEAR(fraction->uRandom, 5e-5, 1e-5);
}

TEST(Energy, IsRefusedThreeStandardUncertaintiesAboveOneAndNotBefore) {
    // u is 2 % of the value: the limit is 1 / (1 - 0.06).
    EXPECT_EQ(energyVerdict(white(1.00)).grade, Grade::Ok);
    EXPECT_EQ(energyVerdict(white(1.06)).grade, Grade::Ok);
    const Verdict over = energyVerdict(white(1.07));
    EXPECT_EQ(over.grade, Grade::Refused) << described(over);
    ASSERT_TRUE(over.figure);
    EXPECT_NEAR(over.figure->value, 1.07, 1e-3);
    EXPECT_FALSE(over.next.empty());
}

TEST(Energy, OfNothingMeasuredIsNotDetermined) {
    EXPECT_FALSE(reflectedFraction(CellSamples::missing(CellGrid::count())));
    EXPECT_EQ(energyVerdict({}).grade, Grade::NotDetermined);
}

}  // namespace
}  // namespace gonio::proc
