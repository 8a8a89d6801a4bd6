#include "proc/estimate/seed004.h"

#include <cmath>

#include "proc/table/scattered_of.h"
#include "tests/estimate/made_up.h"
#include "tests/support/floating_point_traps.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

using test::gridOf;
using test::made;
using test::pairAt;
using test::sampleAt;
using test::setOf;

constexpr std::array kInterpolators{
    SeedInterpolator::Shepard, SeedInterpolator::AxisLinear, SeedInterpolator::GridLinear};
constexpr std::array kExtrapolators{SeedExtrapolator::None,
                                    SeedExtrapolator::Linear,
                                    SeedExtrapolator::Constant,
                                    SeedExtrapolator::Bezier,
                                    SeedExtrapolator::Gradient};

/// Of the interpolator, with a grid that is quickly filled.
Seed004Options options(SeedInterpolator interpolator,
                       SeedExtrapolator beyond = SeedExtrapolator::Constant) {
    return {.interpolator = interpolator,
            .axisLinear = {.incoming = 21_deg, .outgoing = 20_deg},
            .gridLinear = {.incidences = {}, .origin = GridOrigin::Up, .rows = 91, .columns = 36},
            .beyondOutgoing = beyond,
            .beyondIncoming = beyond};
}

/// The planes of a grid end below 90 degrees.
Seed004Options trapped(SeedInterpolator interpolator, SeedExtrapolator beyond) {
    Seed004Options all = options(interpolator, beyond);
    all.gridLinear.incidences = {0_deg, 60_deg};
    all.outgoingEdge = 75_deg;
    all.incomingEdge = 60_deg;
    return all;
}

TEST(Seed004, IsNamedByItsInterpolatorAndWhatIsBeyond) {
    const auto alone = seed004Named("shepard");
    ASSERT_TRUE(alone);
    EXPECT_EQ(alone->interpolator, SeedInterpolator::Shepard);
    EXPECT_EQ(alone->beyondOutgoing, SeedExtrapolator::Constant);
    const auto bezier = seed004Named("grid-linear:bezier");
    ASSERT_TRUE(bezier);
    EXPECT_EQ(bezier->interpolator, SeedInterpolator::GridLinear);
    EXPECT_EQ(bezier->beyondOutgoing, SeedExtrapolator::Bezier);
    EXPECT_EQ(bezier->beyondIncoming, SeedExtrapolator::Bezier);
    for (const char* bad : {"banana", "", ":bezier", "shepard:", "shepard:banana", "bezier"}) {
        EXPECT_FALSE(seed004Named(bad)) << bad;
    }
    // The list names what is understood.
    EXPECT_NE(seed004Names().find("axis-linear, "), std::string::npos) << seed004Names();
    for (const char* beyond : {":none", ":linear", ":constant", ":bezier", ":gradient"}) {
        EXPECT_NE(seed004Names().find(beyond), std::string::npos);
        EXPECT_TRUE(seed004Named(std::string("axis-linear") + beyond)) << beyond;
    }
}

TEST(Seed004, ReproducesAConstantOverTheWholeHemisphere) {
    const ScatteredSet data = gridOf([](double, double, double) { return 0.25; });
    for (const SeedInterpolator interpolator : kInterpolators) {
        const auto chain = made(makeSeed004(data, options(interpolator)));
        for (double i = 0; i < 90; i += 7.3) {
            for (double o = 0; o < 90; o += 6.1) {
                const Answer answer = chain->answer(pairAt(i, o, 3 * i + o));
                ASSERT_TRUE(answer.present())
                    << static_cast<int>(interpolator) << " " << i << " " << o;
                EXPECT_NEAR(answer.f[Band::R], 0.25, 1e-12);
                EXPECT_EQ(answer.source == Source::Extrapolated, i > 60 || o > 75);
            }
        }
    }
}

TEST(Seed004, ExtrapolatesFromTheLargestAnglesOfTheData) {
    std::vector<ScatteredSample> samples;
    for (const double i : {0.0, 40.0, 80.0}) {
        for (double o = 0; o <= 85; o += 5) {
            for (double phi = 0; phi < 360; phi += 15) {
                samples.push_back(sampleAt(pairAt(i, o, phi), i == 80 ? 7 : 1));
            }
        }
    }
    const ScatteredSet data = setOf(samples);
    for (const SeedInterpolator interpolator : kInterpolators) {
        const auto chain = made(makeSeed004(data, options(interpolator)));
        const Answer last = chain->answer(pairAt(80, 85, 30));
        EXPECT_EQ(last.source, Source::Measured) << static_cast<int>(interpolator);
        EXPECT_NEAR(last.f[Band::R], 7, 1e-9) << static_cast<int>(interpolator);
        const Answer beyond = chain->answer(pairAt(85, 40, 30));
        EXPECT_EQ(beyond.source, Source::Extrapolated) << static_cast<int>(interpolator);
        EXPECT_NEAR(beyond.f[Band::R], 7, 1e-9) << static_cast<int>(interpolator);
    }
    // What reaches the horizon leaves nothing beyond.
    const ScatteredSet all =
        setOf({sampleAt(pairAt(0, 89.9999), 0.5), sampleAt(pairAt(90, 90), 1)});
    EXPECT_TRUE(made(makeSeed004(all))->answer(pairAt(0, 89.9999)).present());
}

TEST(Seed004, ExtrapolatesIncidenceOutOfExtrapolatedOutgoingData) {
    const ScatteredSet data = gridOf([](double, double, double) { return 1.0; });
    for (const SeedInterpolator interpolator : kInterpolators) {
        const auto chain = made(makeSeed004(data, options(interpolator, SeedExtrapolator::Linear)));
        // A third of the way to 90 degrees outgoing, half of the way incoming.
        EXPECT_NEAR(chain->answer(pairAt(60, 80)).f[Band::R], 2.0 / 3, 1e-12);
        EXPECT_NEAR(chain->answer(pairAt(75, 80)).f[Band::R], 2.0 / 3 / 2, 1e-12);
        EXPECT_NEAR(chain->answer(pairAt(75, 30)).f[Band::R], 0.5, 1e-12);
    }
}

TEST(Seed004, LeavesTheOutsideUnansweredWithoutExtrapolation) {
    const ScatteredSet data = gridOf([](double, double, double) { return 1.0; });
    const auto chain =
        made(makeSeed004(data, options(SeedInterpolator::Shepard, SeedExtrapolator::None)));
    EXPECT_TRUE(chain->answer(pairAt(60, 75)).present());
    EXPECT_FALSE(chain->answer(pairAt(61, 30)).present());
    EXPECT_FALSE(chain->answer(pairAt(30, 76)).present());
}

TEST(Seed004, AnswersTheCellsOfAMeasuredSample) {
    const auto byPosition = [](Radians incidence, const Direction& wo) {
        return 1 + incidence.value() + 0.3 * wo.x() + 0.2 * wo.y();
    };
    const auto scattered = scatteredOf(gonio::test::sampleSet(byPosition));
    ASSERT_TRUE(scattered);
    for (const SeedInterpolator interpolator :
         {SeedInterpolator::Shepard, SeedInterpolator::AxisLinear}) {
        const auto chain = made(makeSeed004(scattered->set, {.interpolator = interpolator}));
        const Direction wi = Direction::fromSpherical(20_deg, Radians(0));
        for (std::size_t cell = 5; cell < 15'000; cell += 701) {
            const Answer answer = chain->answer({wi, CellGrid::centre(cell)});
            EXPECT_EQ(answer.source, Source::Measured);
            EXPECT_NEAR(answer.f[Band::R], byPosition(20_deg, CellGrid::centre(cell)), 1e-12);
        }
        // Between cells, and just inside the edge, which is the last row of centres.
        for (const LightView& pair : {pairAt(20, 40.2, 33), pairAt(20, 74.4, 100)}) {
            const Answer answer = chain->answer(pair);
            EXPECT_EQ(answer.source, Source::Interpolated);
            EXPECT_NEAR(answer.f[Band::R], byPosition(20_deg, pair.out), 0.02);
        }
        EXPECT_EQ(chain->answer(pairAt(20, 88)).source, Source::Extrapolated);
    }
}

TEST(Seed004, HandlesOneSampleAndAllCellsMissingButOne) {
    const ScatteredSet one = setOf({sampleAt(pairAt(0, 0), 0.5)});
    for (const SeedInterpolator interpolator : kInterpolators) {
        const auto chain = made(makeSeed004(one, options(interpolator)));
        const Answer answer = chain->answer(pairAt(0, 0));
        EXPECT_DOUBLE_EQ(answer.f[Band::R], 0.5) << static_cast<int>(interpolator);
        EXPECT_EQ(answer.source, Source::Measured);
        // All else lies beyond it.
        EXPECT_EQ(chain->answer(pairAt(45, 70)).source, Source::Extrapolated);
    }
}

TEST(Seed004, RunsThroughItsExtremesWithTrapsOn) {
    const ScatteredSet spike = setOf({sampleAt(pairAt(0, 0), 1e3),
                                      sampleAt(pairAt(0, 0), 1e3),
                                      sampleAt(pairAt(0, 1), 1e-3),
                                      sampleAt(pairAt(60, 75, 180), -1e-4),
                                      sampleAt(pairAt(90, 90), 0)});
    const gonio::test::FloatingPointTraps traps;
    for (const SeedInterpolator interpolator : kInterpolators) {
        for (const SeedExtrapolator extrapolator : kExtrapolators) {
            const auto chain = made(makeSeed004(spike, trapped(interpolator, extrapolator)));
            std::size_t present = 0;
            for (const double i : {0.0, 1e-9, 60.0, 60.5, 90.0}) {
                for (const double o : {0.0, 1e-9, 75.0, 75.1, 90.0}) {
                    const Answer answer = chain->answer(pairAt(i, o, 180));
                    if (!answer.present()) continue;
                    ++present;
                    EXPECT_LE(std::abs(answer.f[Band::R]), 1e3 * (1 + 1e-12));
                }
            }
            EXPECT_GT(present, 0U)
                << static_cast<int>(interpolator) << " " << static_cast<int>(extrapolator);
        }
    }
}

TEST(Seed004, RefusesNoData) {
    SampleSet missing = gonio::test::sampleSet([](Radians, const Direction&) { return 0.1; });
    for (LedTable& led : missing.leds) led.bands = {};
    for (const SeedInterpolator interpolator : kInterpolators) {
        for (const auto& none :
             {makeSeed004(ScatteredSet{}, options(interpolator)), makeSeed004(missing)}) {
            ASSERT_FALSE(none);
            EXPECT_EQ(none.error().kind, ErrorKind::Quality) << none.error().message;
        }
    }
}

TEST(Seed004, UsesTheBandsThatWereMeasuredEachInItsOwnCells) {
    SampleSet sample = gonio::test::sampleSet([](Radians, const Direction&) { return 0.1; });
    sample.leds.resize(2);
    for (LedTable& led : sample.leds) {
        led.bands[1] = {};
        // Blue is missing where red is there: one hole of its own.
        led.bands[2].flags[4000].clear(Flag::Measured);
    }
    const LightView hole{Direction::fromSpherical(20_deg, Radians(0)), CellGrid::centre(4000)};
    for (const SeedInterpolator interpolator :
         {SeedInterpolator::Shepard, SeedInterpolator::AxisLinear}) {
        const auto chain = made(makeSeed004(sample, {.interpolator = interpolator}));
        const Answer answer = chain->answer(hole);
        EXPECT_DOUBLE_EQ(answer.f[Band::R], 0.1) << static_cast<int>(interpolator);
        EXPECT_TRUE(std::isnan(answer.f[Band::G]));
        EXPECT_NEAR(answer.f[Band::B], 0.3, 1e-12);
        EXPECT_DOUBLE_EQ((*answer.uRandom)[Band::R], 1e-3);
        EXPECT_EQ(answer.source, Source::Interpolated) << "of blue";
        EXPECT_EQ(chain->answer({hole.in, CellGrid::centre(4001)}).source, Source::Measured);
        EXPECT_FALSE(chain->answer(pairAt(20, 95)).present());
    }
}

TEST(Seed004, RefusesAGridOfAGridAndOptionsOutOfTheirDomain) {
    const ScatteredSet data = gridOf([](double, double, double) { return 1.0; });
    Seed004Options nested = options(SeedInterpolator::GridLinear);
    nested.gridFilledBy = SeedInterpolator::GridLinear;
    Seed004Options edge = options(SeedInterpolator::Shepard);
    edge.incomingEdge = 90_deg;
    Seed004Options few = options(SeedInterpolator::Shepard);
    few.shepard.fewest = 0;
    for (const Seed004Options& bad : {nested, edge, few}) {
        test::expectUsageError(makeSeed004(data, bad));
    }
    std::vector<ScatteredSample> scattered;
    for (int i = 0; i < 300; ++i) scattered.push_back(sampleAt(pairAt(0.2 * i, 10), 1));
    test::expectUsageError(makeSeed004(setOf(scattered), options(SeedInterpolator::GridLinear)));
}

}  // namespace
}  // namespace gonio::proc
