#include "tests/support/sample_sets.h"

#include "proc/table/sample_lookup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "proc/core/coordinates.h"

namespace gonio::proc {
namespace {

double byPosition(Radians incidence, const Direction& wo) {
    return 1 + incidence.value() + 0.3 * wo.x() + 0.2 * wo.y() + 0.1 * wo.z();
}

const SampleLookup& lookup() {
    static const SampleLookup made(test::sampleSet(byPosition));
    return made;
}

Direction ledAt(double degrees) {
    return Direction::fromSpherical(Radians::fromDegrees(degrees), Radians(0));
}

TEST(SampleLookup, AnswersTheCellAtItsCentre) {
    for (const double incidence : {0.0, 20.0, 60.0}) {
        for (std::size_t cell = 0; cell < CellGrid::count(); cell += 37) {
            const Direction wo = CellGrid::centre(cell);
            const Answer answer = lookup().answer({ledAt(incidence), wo});
            if (CellGrid::place(cell).row >= 75) {
                EXPECT_FALSE(answer.present());
                EXPECT_EQ(answer.flags, Flags{Flag::Blocked});
                continue;
            }
            const double f = byPosition(Radians::fromDegrees(incidence), wo);
            EXPECT_NEAR(answer.f[Band::R], f, 1e-8);
            EXPECT_NEAR(answer.f[Band::B], 3 * f, 1e-8);
            EXPECT_NEAR((*answer.uRandom)[Band::R], 0.01 * f, 1e-8);
            EXPECT_NEAR((*answer.uSystematic)[Band::R], 0.02 * f, 1e-8);
            EXPECT_EQ(answer.flags, Flags{Flag::Measured});
            EXPECT_EQ(answer.source, Source::Measured);
        }
    }
}

TEST(SampleLookup, FollowsASmoothFunctionBetweenCentresAndAcrossThePole) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 5000; ++i) {
        // Half of them within two degrees of the normal.
        const double theta = (i % 2 == 0 ? 74.4 : 2) * unit(random);
        const Direction wo =
            Direction::fromSpherical(Radians::fromDegrees(theta), Radians(2 * kPi * unit(random)));
        const Answer answer = lookup().answer({ledAt(40), wo});
        // Linear over a cell of width w misses w^2/8 of the second derivative; near the pole three
        // sectors of 120 degrees stand half a degree away.
        EXPECT_NEAR(answer.f[Band::R], byPosition(40_deg, wo), 6e-3) << theta;
    }
}

TEST(SampleLookup, IsContinuousAcrossTheHalfDegreeRowAndPhiZero) {
    const auto f = [](double theta, double phi) {
        return lookup()
            .answer(
                {ledAt(20),
                 Direction::fromSpherical(Radians::fromDegrees(theta), Radians::fromDegrees(phi))})
            .f[Band::G];
    };
    EXPECT_NEAR(f(0.5 - 1e-7, 77), f(0.5 + 1e-7, 77), 1e-6);
    EXPECT_NEAR(f(33, 1e-7), f(33, 360 - 1e-7), 1e-6);
    EXPECT_NEAR(f(1e-9, 0), f(1e-9, 180), 1e-6);
}

TEST(SampleLookup, IsIsotropic) {
    const Direction wi = Direction::fromSpherical(20_deg, 0_deg);
    const Direction wo = Direction::fromSpherical(33.3_deg, 140_deg);
    const double f = lookup().answer({wi, wo}).f[Band::G];
    for (const Radians turn : {10_deg, 123_deg, 270_deg}) {
        EXPECT_NEAR(lookup().answer({wi.turned(turn), wo.turned(turn)}).f[Band::G], f, 1e-12);
    }
}

TEST(SampleLookup, TakesAnLedWithinHalfADegreeAndNothingBeyondTheLast) {
    const Direction wo = ledAt(10);
    const double f = lookup().answer({ledAt(60), wo}).f[Band::R];
    EXPECT_EQ(lookup().answer({ledAt(60.49), wo}).f[Band::R], f);
    EXPECT_EQ(lookup().answer({ledAt(59.51), wo}).f[Band::R], f);
    const Answer beyond = lookup().answer({ledAt(60.51), wo});
    EXPECT_FALSE(beyond.present());
    EXPECT_EQ(beyond.source, Source::Interpolated);
}

TEST(SampleLookup, IsLinearInIncidenceAtEqualSpecularRelativeCoordinates) {
    const SampleLookup byIncidence(
        test::sampleSet([](Radians incidence, const Direction&) { return 1 + incidence.value(); }));
    const Answer answer = byIncidence.answer({ledAt(30), ledAt(5)});
    EXPECT_NEAR(answer.f[Band::R], 1 + (30_deg).value(), 1e-12);
    EXPECT_EQ(answer.flags, Flags{Flag::Interpolated});
    EXPECT_EQ(answer.source, Source::Interpolated);
    // Independent cells average, a common error does not.
    EXPECT_LT((*answer.uRandom)[Band::R], 0.008 * answer.f[Band::R]);
    EXPECT_NEAR((*answer.uSystematic)[Band::R], 0.02 * answer.f[Band::R], 1e-12);

    const SampleLookup byRadial(test::sampleSet([](Radians incidence, const Direction& wo) {
        const Direction wi = Direction::fromSpherical(incidence, Radians(0));
        return std::exp(-toSpecularRelative({wi, wo}).radial.value());
    }));
    const LightView pair{ledAt(50), Direction::fromSpherical(40_deg, 160_deg)};
    EXPECT_NEAR(
        byRadial.answer(pair).f[Band::R], std::exp(-toSpecularRelative(pair).radial.value()), 1e-3);
}

TEST(SampleLookup, AMissingBandLeavesTheOthers) {
    SampleSet set = test::sampleSet(byPosition);
    for (LedTable& led : set.leds) led.bands[index(Band::B)] = {};
    const Answer answer = SampleLookup(set).answer({ledAt(20), ledAt(10)});
    EXPECT_TRUE(std::isnan(answer.f[Band::B]));
    EXPECT_TRUE(std::isnan((*answer.uRandom)[Band::B]));
    EXPECT_FALSE(std::isnan(answer.f[Band::R]));
}

TEST(SampleLookup, AnswersNothingBelowTheHorizonOrWithoutLeds) {
    const Answer below = lookup().answer({ledAt(20), ledAt(120)});
    EXPECT_EQ(below.flags, Flags{Flag::BelowHorizon});
    EXPECT_FALSE(lookup().answer({ledAt(95), ledAt(10)}).present());
    EXPECT_FALSE(SampleLookup(SampleSet{}).answer({ledAt(20), ledAt(10)}).present());
}

TEST(SampleLookup, AnswersNothingNextToAMissingCell) {
    SampleSet set = test::sampleSet(byPosition);
    const std::size_t hole = CellGrid::index({30, 10});
    for (auto& cells : set.leds[1].bands) {
        cells.f[hole] = std::nan("");
        cells.flags[hole] = Flags{Flag::Saturated};
    }
    const SampleLookup at(set);
    const Direction centre = CellGrid::centre(hole);
    const Answer answer = at.answer({ledAt(20), centre});
    EXPECT_FALSE(answer.present());
    EXPECT_EQ(answer.flags, Flags{Flag::Saturated});
    EXPECT_FALSE(at.answer({ledAt(20), centre.turned(0.5_deg)}).present());
    EXPECT_TRUE(at.answer({ledAt(40), centre}).present());
}

TEST(SampleLookup, SortsItsLedsByIncidence) {
    SampleSet shuffled = test::sampleSet([](Radians, const Direction&) { return 0.1; });
    std::swap(shuffled.leds[0], shuffled.leds[3]);
    const SampleLookup lookup(shuffled);
    ASSERT_EQ(lookup.set().leds.size(), 4U);
    for (std::size_t i = 1; i < 4; ++i)
        EXPECT_LT(lookup.set().leds[i - 1].incidence, lookup.set().leds[i].incidence);
    EXPECT_EQ(lookup.set().info, shuffled.info);
}

}  // namespace
}  // namespace gonio::proc
