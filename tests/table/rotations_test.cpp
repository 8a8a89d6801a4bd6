#include "proc/table/rotations.h"

#include <gtest/gtest.h>

#include "proc/table/merged_info.h"
#include "proc/table/sample_lookup.h"
#include "proc/table/scattered_of.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

/// Of a brushed surface: it knows where its own x is, by the light and by the view.
double brushed(const LightView& pair) {
    return 2 + pair.in.x() + 0.5 * pair.out.x() - 0.25 * pair.out.y() + pair.in.y() * pair.out.x();
}

LedTable turnedTable(Radians incidence, double rotationDeg) {
    LedTable led{.incidence = incidence, .rotation = rotationOf(rotationDeg), .bands = {}};
    led.bands = test::ledTable(incidence, [&](Radians, const Direction& wo) {
                    return brushed(pairInSample(led, wo));
                }).bands;
    return led;
}

const SampleSet& turnedSample() {
    static const SampleSet made = [] {
        SampleSet set;
        for (const double rotation : {90.0, 0.0, 45.0}) {
            for (const Radians incidence : {0_deg, 20_deg, 60_deg}) {
                set.leds.push_back(turnedTable(incidence, rotation));
            }
        }
        return set;
    }();
    return made;
}

TEST(Rotations, AreOneForEachPlaceOnTheTurn) {
    EXPECT_EQ(rotationOf(-90), rotationOf(270));
    EXPECT_EQ(rotationOf(360), Radians(0));
    EXPECT_EQ(rotationOf(-360), Radians(0));
    EXPECT_EQ(rotationOf(-1e-12), Radians(0));
    EXPECT_FALSE(std::signbit(rotationOf(-0.0).value()));
    EXPECT_EQ(rotationOf(45), 45_deg);
    EXPECT_TRUE(sameRotation(rotationOf(359.995), Radians(0)));
    EXPECT_FALSE(sameRotation(rotationOf(359.98), Radians(0)));
    EXPECT_EQ(rotationsOf(turnedSample()), (std::vector{0_deg, 45_deg, 90_deg}));
    EXPECT_EQ(tablesAt(turnedSample(), 45_deg).leds.size(), 3U);
    EXPECT_TRUE(tablesAt(turnedSample(), 30_deg).leds.empty());
}

TEST(Rotations, LookUpAndScatteredSamplesAreInTheSamplesOwnFrame) {
    const SampleLookup lookup(turnedSample());
    for (const LedTable& led : lookup.set().leds) {
        for (std::size_t cell = 0; cell < CellGrid::count(); cell += 61) {
            if (CellGrid::place(cell).row >= 75) continue;
            const LightView pair = pairInSample(led, CellGrid::centre(cell));
            const Answer answer = lookup.answer(pair);
            // Bilinear over a cell, as at the normal the first rotation answers for all.
            const double u = led.incidence == 0_deg ? 5e-3 : 1e-12;
            ASSERT_NEAR(answer.f[Band::R], brushed(pair), u) << led.rotation.degrees();
            if (led.incidence > 0_deg) {
                ASSERT_EQ(answer.source, Source::Measured);
            }
        }
    }
    // Halfway between two rotations light and view turn together: linear in between, with the
    // chord's error 1 - cos(22.5 degrees) of what turns.
    const LightView between{.in = Direction::fromSpherical(20_deg, -22.5_deg),
                            .out = Direction::fromSpherical(30_deg, 100_deg)};
    EXPECT_NEAR(lookup.answer(between).f[Band::R], brushed(between), 0.08 * 0.8);
    EXPECT_EQ(lookup.answer(between).source, Source::Interpolated);
    // Nobody measured the other side.
    EXPECT_FALSE(lookup.answer({Direction::fromSpherical(20_deg, 90_deg), Direction()}).present());

    const auto scattered = scatteredOf(turnedSample());
    ASSERT_TRUE(scattered);
    EXPECT_EQ(scattered->set.symmetry(), PairSymmetry::None);
    for (SampleId id = 0; id < scattered->set.size(); id += 997) {
        const ScatteredSample& one = *scattered->set.find(id);
        EXPECT_NEAR(one.f[Band::R], brushed(one.pair), 1e-12);
    }
}

}  // namespace
}  // namespace gonio::proc
