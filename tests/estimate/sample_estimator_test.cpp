#include "proc/estimate/sample_estimator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/estimate/grid_data.h"
#include "proc/estimate/interpolation_study.h"
#include "proc/models/spec.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/rotations.h"
#include "tests/estimate/made_up.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

using test::pairAt;

std::unique_ptr<const AnalyticModel> plastic() {
    return std::move(*makeModel("lambert,albedo=0.3/0.1/0.05+ggx,alpha=0.2,f0=0.04"));
}

/// Of the plastic, with 1 % of noise.
SampleSet plasticSample() {
    static const SampleSet set = syntheticSample(*plastic(), {.relativeNoise = 0.01});
    return set;
}

std::unique_ptr<const SampleEstimator> estimator(SampleSet set,
                                                 SampleEstimatorOptions options = {}) {
    auto made = SampleEstimator::over(std::move(set), std::move(options));
    EXPECT_TRUE(made) << made.error().message;
    return std::move(*made);
}

/// By one method, which costs no choice: each test is a program of its own.
const SampleEstimator& ofPlastic() {
    static const auto made =
        estimator(plasticSample(), {.method = "carried:lambert+ggx", .effort = Effort::Draft});
    return *made;
}

TEST(SampleEstimator, AnswersAMeasuredCellAsItWasMeasured) {
    const SampleSet set = plasticSample();
    for (const std::size_t cell : {std::size_t{3}, std::size_t{7777}}) {
        const LightView pair{.in = Direction::fromSpherical(40_deg, 0_deg),
                             .out = CellGrid::centre(cell)};
        const Answer answer = ofPlastic().answer(pair);
        EXPECT_EQ(answer.source, Source::Measured);
        EXPECT_EQ(answer.f[Band::G], set.leds[2].bands[1].f[cell]);
    }
}

/// An isotropic sample does not feel how it lies; one of several rotations is refused.
TEST(SampleEstimator, TakesATurnedSampleAsIfItWereNot) {
    SampleSet set = plasticSample();
    const SampleEstimatorOptions options{.method = "carried:lambert+ggx", .effort = Effort::Draft};
    turnTo(set, 45_deg);
    const auto turned = estimator(set, options);
    for (const LightView& pair : {pairAt(30, 50, 140), pairAt(70, 60, 180)}) {
        EXPECT_EQ(turned->answer(pair).f[Band::G], ofPlastic().answer(pair).f[Band::G]);
    }
    set.leds.front().rotation = Radians();
    const auto refused = SampleEstimator::over(set, options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Usage);
}

TEST(SampleEstimator, AnswersEverywhereAboveTheHorizonWithAnUncertainty) {
    const auto learned = estimator(plasticSample(), {.method = "specular-log"});
    for (const double thetaI : {0.0, 0.01, 10.0, 45.0, 60.0, 61.0, 75.0, 89.99}) {
        for (const double thetaO : {0.0, 0.01, 30.0, 60.0, 75.0, 77.0, 89.99}) {
            for (const double phi : {0.0, 90.0, 180.0, 300.0}) {
                const Answer answer = learned->answer(pairAt(thetaI, thetaO, phi));
                ASSERT_TRUE(answer.present()) << thetaI << " " << thetaO << " " << phi;
                for (const Band band : kBands) {
                    EXPECT_GT(answer.f[band], 0);
                    ASSERT_TRUE(answer.u(band));
                    EXPECT_GT(*answer.u(band), 0);
                }
            }
        }
    }
}

TEST(SampleEstimator, HasNoAnswerBelowTheHorizon) {
    const Answer answer = ofPlastic().answer(pairAt(20, 95, 0));
    EXPECT_FALSE(answer.present());
    EXPECT_TRUE(answer.flags.has(Flag::BelowHorizon));
}

TEST(SampleEstimator, ChoosesWhatIsRightBetweenAndBeyondTheAngles) {
    const auto truth = plastic();
    const auto chosen = estimator(plasticSample(), {.prior = standardPrior});
    const RegionError between =
        errorOf(*chosen, *truth, {.incidences = {10_deg, 30_deg, 50_deg}, .stride = 29});
    EXPECT_LT(between.hemisphere, 0.003);
    EXPECT_LT(between.lobe, 0.008);
    EXPECT_GT(between.within2u, 0.9);
    EXPECT_EQ(between.unanswered, 0);
    const RegionError steep = errorOf(*chosen, *truth, {.incidences = {70_deg}, .stride = 29});
    EXPECT_LT(steep.hemisphere, 0.02);
    const RegionError grazing =
        errorOf(*chosen,
                *truth,
                {.incidences = {20_deg, 40_deg}, .firstRow = 80, .lastRow = 85, .stride = 29});
    EXPECT_LT(grazing.hemisphere, 0.03);
    const MethodChoice& choice = chosen->choice();
    EXPECT_TRUE(choice.between.method->name().find("ggx") != std::string::npos ||
                choice.between.method->name().find("gtr") != std::string::npos)
        << choice.between.method->name();
    ASSERT_FALSE(choice.scores.empty());
    for (std::size_t i = 1; i < choice.scores.size(); ++i) {
        EXPECT_LE(choice.scores[i - 1].between(), choice.scores[i].between());
    }
    // What everyone does errs by some ten times more.
    for (const MethodScore& score : choice.scores) {
        if (score.name != "specular-linear") continue;
        EXPECT_GT(score.between(), 10 * choice.scores.front().between());
    }
}

/// A lobe that leans out of the plane is no isotropic model's: where the light was measured, the
/// cells say so, and between two of them, too.
TEST(SampleEstimator, KeepsToTheCellsOfAnIncidenceThatWasMeasured) {
    const auto surface = plastic();
    SampleSet set = plasticSample();
    for (LedTable& led : set.leds) {
        for (CellSamples& cells : led.bands) {
            for (std::size_t i = 0; i < cells.size(); ++i) {
                cells.f[i] *= 1 + 0.3 * CellGrid::centre(i).y();
            }
        }
    }
    const auto made = estimator(set);
    const Answer answer = made->answer(pairAt(40, 50, 90));  // between four cells
    const double leaning = surface->answer(pairAt(40, 50, 90)).f[Band::R] * (1 + 0.3 * sin(50_deg));
    EXPECT_NEAR(answer.f[Band::R], leaning, 0.02 * leaning);
    EXPECT_NEAR(answer.f[Band::R], leaning, 3 * *answer.u(Band::R));
}

TEST(SampleEstimator, SaysWhereAnAnswerComesFrom) {
    const auto carried =
        estimator(plasticSample(), {.method = "carried:lambert+ggx", .effort = Effort::Draft});
    const Answer between = carried->answer(pairAt(30, 50, 70));
    EXPECT_EQ(between.source, Source::Interpolated);
    EXPECT_TRUE(between.flags.has(Flag::Interpolated) && between.flags.has(Flag::Model));
    // 70 to 40 degrees was measured the other way round.
    const Answer exchanged = carried->answer(pairAt(70, 40, 100));
    EXPECT_EQ(exchanged.source, Source::Reciprocity);
    EXPECT_TRUE(exchanged.flags.has(Flag::Reciprocity));
    const Answer beyond = carried->answer(pairAt(85, 85, 180));
    EXPECT_EQ(beyond.source, Source::Model);
    EXPECT_TRUE(beyond.flags.has(Flag::Extrapolated));
    const auto sheets =
        estimator(plasticSample(), {.method = "specular-log", .effort = Effort::Draft});
    EXPECT_EQ(sheets->answer(pairAt(85, 85, 180)).source, Source::Extrapolated);
    const auto prior = estimator(
        plasticSample(), {.method = "prior", .effort = Effort::Draft, .prior = standardPrior});
    EXPECT_EQ(prior->answer(pairAt(30, 50, 70)).source, Source::Prior);
    EXPECT_TRUE(prior->answer(pairAt(30, 50, 70)).flags.has(Flag::Prior));
}

TEST(SampleEstimator, DoesNotJumpAtTheEdgesOfWhatWasMeasured) {
    for (const double edge : {60.0, 75.0}) {
        for (const double other : {13.0, 33.0, 71.0}) {
            const double low = ofPlastic().answer(pairAt(edge - 1e-6, other, 150)).f[Band::R];
            const double high = ofPlastic().answer(pairAt(edge + 1e-6, other, 150)).f[Band::R];
            EXPECT_NEAR(low, high, 1e-5 * low) << edge << " " << other;
        }
    }
}

TEST(SampleEstimator, TellsNoUncertaintyThatItDoesNotKnow) {
    // Nothing was left out, so that nobody knows what the method is wrong by.
    EXPECT_FALSE(ofPlastic().answer(pairAt(30, 50, 70)).u(Band::R));
    const LightView cell{.in = Direction::fromSpherical(40_deg, 0_deg),
                         .out = CellGrid::centre(5000)};
    EXPECT_TRUE(ofPlastic().answer(cell).u(Band::R));
    // Between cells of an incidence that was measured, their own is all there is.
    EXPECT_TRUE(ofPlastic().answer(pairAt(40, 33, 70)).u(Band::R));
    // Values without an uncertainty: what they were predicted wrong by, their noise in it.
    const auto grey = std::shared_ptr<const Scatterer>(plastic());
    auto made = SampleEstimator::over(
        grey, gridDataOf(*grey, {0_deg, 20_deg, 40_deg, 60_deg}), {.method = "specular-log"});
    ASSERT_TRUE(made) << made.error().message;
    const Answer answer = (*made)->answer(pairAt(30, 50, 70));
    EXPECT_FALSE(answer.uRandom);
    EXPECT_GT(*answer.u(Band::R), 0);
}

TEST(SampleEstimator, TakesEachBandWhereItWasMeasured) {
    SampleSet set = plasticSample();
    const std::size_t cell = *CellGrid::cellAt(Direction::fromSpherical(40_deg, 180_deg));
    const LightView pair{.in = Direction::fromSpherical(40_deg, 0_deg),
                         .out = CellGrid::centre(cell)};
    for (std::size_t i = 0; i < CellGrid::count(); ++i) {  // the lobe of red alone
        if (angleBetween({.in = pair.out, .out = CellGrid::centre(i)}) > 5_deg) continue;
        set.leds[2].bands[0].flags[i] = Flags{Flag::Saturated};
    }
    const auto made = estimator(set, {.method = "specular-log"});
    const Answer answer = made->answer(pair);
    EXPECT_NE(answer.source, Source::Measured);
    for (const Band band : {Band::G, Band::B}) {
        EXPECT_EQ(answer.f[band], set.leds[2].bands[index(band)].f[cell]);
        EXPECT_EQ((*answer.uRandom)[band], set.leds[2].bands[index(band)].uRandom[cell]);
    }
    // Closed from its rim, and said to be uncertain.
    const double off = answer.f[Band::R] - plastic()->answer(pair).f[Band::R];
    EXPECT_GT(*answer.u(Band::R) / answer.f[Band::R], 5 * *answer.u(Band::G) / answer.f[Band::G]);
    EXPECT_LT(std::abs(off), 3 * *answer.u(Band::R));
}

TEST(SampleEstimator, TakesForMeasuredOnlyTheIncidenceItself) {
    const std::size_t cell = *CellGrid::cellAt(Direction::fromSpherical(23.5_deg, 180_deg));
    const auto at = [&](double incidence) {
        return ofPlastic().answer(
            {.in = Direction::fromSpherical(Radians::fromDegrees(incidence), 0_deg),
             .out = CellGrid::centre(cell)});
    };
    EXPECT_EQ(at(20).source, Source::Measured);
    EXPECT_NE(at(20.4).source, Source::Measured);
    EXPECT_NE(at(20.4).f[Band::R], at(20).f[Band::R]);
}

TEST(SampleEstimator, IsReciprocalAndIsotropic) {
    for (const LightView& pair : {pairAt(30, 50, 70), pairAt(66, 80, 170), pairAt(5, 12, 40)}) {
        const double f = ofPlastic().answer(pair).f[Band::R];
        EXPECT_NEAR(ofPlastic().answer({.in = pair.out, .out = pair.in}).f[Band::R], f, 1e-9 * f);
        const LightView turned{.in = pair.in.turned(77_deg), .out = pair.out.turned(77_deg)};
        EXPECT_NEAR(ofPlastic().answer(turned).f[Band::R], f, 1e-9 * f);
    }
}

TEST(SampleEstimator, FillsBlockedAndSaturatedCellsFromTheOthers) {
    SampleSet set = plasticSample();
    const Direction hole = Direction::fromSpherical(20_deg, 90_deg);
    for (LedTable& led : set.leds) {
        for (CellSamples& cells : led.bands) {
            for (std::size_t i = 0; i < cells.size(); ++i) {
                const Radians away = angleBetween({.in = hole, .out = CellGrid::centre(i)});
                if (away > 6_deg) continue;
                cells.f[i] = 1e6;  // must not be looked at
                cells.flags[i] = Flags{Flag::Measured, Flag::Blocked};
            }
        }
    }
    const auto holed = estimator(set, {.method = "carried:lambert+ggx", .effort = Effort::Draft});
    const LightView pair{.in = Direction::fromSpherical(40_deg, 0_deg),
                         .out = CellGrid::centre(*CellGrid::cellAt(hole))};
    const Answer answer = holed->answer(pair);
    EXPECT_NE(answer.source, Source::Measured);
    EXPECT_NEAR(answer.f[Band::R], plastic()->answer(pair).f[Band::R], 0.01 * answer.f[Band::R]);
}

TEST(SampleEstimator, KeepsTheSystematicUncertaintyOfWhatItWasMadeFrom) {
    SampleSet set = plasticSample();
    for (LedTable& led : set.leds) {
        for (CellSamples& cells : led.bands) {
            for (std::size_t i = 0; i < cells.size(); ++i) cells.uSystematic[i] = 0.04 * cells.f[i];
        }
    }
    for (const char* method : {"model:lambert+ggx", "carried:lambert+ggx", "prior"}) {
        const auto made = estimator(set, {.method = method, .prior = standardPrior});
        const Answer answer = made->answer(pairAt(30, 50, 70));
        EXPECT_NEAR((*answer.uSystematic)[Band::R] / answer.f[Band::R], 0.04, 0.005) << method;
    }
}

TEST(SampleEstimator, RefusesWhatCannotBe) {
    EXPECT_EQ(SampleEstimator::over(plasticSample(), {.method = "banana"}).error().kind,
              ErrorKind::Usage);
    // No prior was given.
    EXPECT_EQ(SampleEstimator::over(plasticSample(), {.method = "prior"}).error().kind,
              ErrorKind::Usage);
    SampleSet nothing = plasticSample();
    for (LedTable& led : nothing.leds) {
        for (CellSamples& cells : led.bands) cells = CellSamples::missing(CellGrid::count());
    }
    EXPECT_EQ(SampleEstimator::over(nothing, {}).error().kind, ErrorKind::Quality);
}

TEST(SampleEstimator, StandsOnOneIncidenceAndOnOneCell) {
    SampleSet one = plasticSample();
    one.leds.erase(one.leds.begin() + 1, one.leds.end());
    const auto single = estimator(one);
    EXPECT_TRUE(single->answer(pairAt(50, 30, 20)).present());
    EXPECT_FALSE(single->answer(pairAt(50, 30, 20)).u(Band::R));
    for (CellSamples& cells : one.leds[0].bands) {
        const double f = cells.f[100];
        const double u = cells.uRandom[100];
        cells = CellSamples::missing(CellGrid::count());
        cells.f[100] = f;
        cells.uRandom[100] = u;
        cells.uSystematic[100] = 0;
        cells.flags[100] = Flags{Flag::Measured};
    }
    const auto lonely = estimator(one);
    const Answer answer = lonely->answer(pairAt(50, 30, 20));
    EXPECT_TRUE(answer.present());
    EXPECT_TRUE(answer.flags.has(Flag::Extrapolated));
}

TEST(SampleEstimator, KeepsOneBandAsOne) {
    const auto grey = std::shared_ptr<const Scatterer>(plastic());
    BrdfData data = gridDataOf(*grey, {0_deg, 20_deg, 40_deg, 60_deg}, {.assumedRelative = 0.01});
    data.bands = BandCount::One;
    for (FitRow& row : data.rows) row.f[1] = row.f[2] = std::nan("");
    auto made = SampleEstimator::over(grey, std::move(data), {.method = "specular-log"});
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ((*made)->bandCount(), BandCount::One);
    const Answer answer = (*made)->answer(pairAt(30, 50, 70));
    EXPECT_EQ(answer.f[Band::G], answer.f[Band::R]);
    EXPECT_EQ(answer.u(Band::B), answer.u(Band::R));
    EXPECT_GT(answer.f[Band::B], 0.09);  // of red's albedo of 0.3
}

}  // namespace
}  // namespace gonio::proc
