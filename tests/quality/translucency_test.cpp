#include "proc/quality/translucency.h"

#include <gtest/gtest.h>

#include "proc/table/rotations.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

/// f of a grey of reflectance 0.3, and `through` more reflectance in each band; u is 0.1 % of f.
SampleSet grey(const LedBands& through) {
    SampleSet set =
        test::sampleSet([](Radians /*incidence*/, const Direction& /*wo*/) { return 0.3 / kPi; });
    for (LedTable& led : set.leds) {
        for (const Band band : kBands) {
            CellSamples& cells = led.bands[index(band)];
            for (std::size_t i = 0; i < cells.size(); ++i) {
                cells.f[i] = (0.3 + through[band]) / kPi;
                cells.uSystematic[i] = 1e-3 * cells.f[i];
            }
        }
    }
    return set;
}

const LedBands kDeep{0.087, 0.052, 0.035};

TEST(Translucency, IsTheDifferenceBetweenTheBackingsByBand) {
    const SampleSet black = grey({}), white = grey(kDeep);
    const auto difference = backingDifference({.black = black, .white = white});
    ASSERT_TRUE(difference);
    for (const Band band : kBands) {
        EXPECT_NEAR(difference->reflectance[band], kDeep[band], 1e-9);
        EXPECT_GT(difference->u[band], 3e-4);
        EXPECT_LT(difference->u[band], 6e-4);
    }
}

TEST(Translucency, IsWarnedOfOnBlackAndRefusedOnWhite) {
    const SampleSet black = grey({}), white = grey(kDeep);
    const auto difference = backingDifference({.black = black, .white = white});
    const Verdict onBlack = translucencyVerdict(difference, Backing::Black);
    EXPECT_EQ(onBlack.grade, Grade::Warned) << described(onBlack);
    EXPECT_EQ(onBlack.evidence.find("not most in red"), std::string::npos);
    const Verdict onWhite = translucencyVerdict(difference, Backing::White);
    EXPECT_EQ(onWhite.grade, Grade::Refused);
    EXPECT_NE(onWhite.next.find("black backing"), std::string::npos);
}

TEST(Translucency, SaysWhereRedIsNotTheLargest) {
    const SampleSet black = grey({}), white = grey({0.01, 0.02, 0.03});
    const auto difference = backingDifference({.black = black, .white = white});
    EXPECT_NE(translucencyVerdict(difference, Backing::Black).evidence.find("not most in red"),
              std::string::npos);
}

TEST(Translucency, OpaqueSamplesPass) {
    const SampleSet black = grey({}), white = grey({0.004, 0.004, 0.004});
    const auto difference = backingDifference({.black = black, .white = white});
    EXPECT_EQ(translucencyVerdict(difference, Backing::White).grade, Grade::Ok);
}

TEST(Translucency, OfOneMeasurementIsNotDeterminedAndSaysWhatToDo) {
    const Verdict alone = translucencyVerdict({}, Backing::Black);
    EXPECT_EQ(alone.grade, Grade::NotDetermined);
    EXPECT_NE(alone.next.find("--backing white --against"), std::string::npos) << alone.next;
    EXPECT_EQ(translucencyVerdict({}, {}).grade, Grade::NotDetermined);
    const SampleSet black = grey({});
    EXPECT_FALSE(backingDifference({.black = black, .white = {}}));
    SampleSet turned = grey(kDeep);
    turnTo(turned, 90_deg);
    EXPECT_FALSE(backingDifference({.black = black, .white = turned}));
}

TEST(Translucency, BackingsHaveNames) {
    for (const Backing backing : {Backing::Black, Backing::White}) {
        EXPECT_EQ(parseBacking(name(backing)).value(), backing);
    }
    EXPECT_EQ(parseBacking("grey").error().kind, ErrorKind::Usage);
}

}  // namespace
}  // namespace gonio::proc
