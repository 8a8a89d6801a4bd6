#include "proc/estimate/sample_albedo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "proc/optics/cell_grid.h"
#include "tests/estimate/scatterers.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

LedTable uniform(double f) {
    return test::ledTable(20_deg, [f](Radians, const Direction&) { return f; });
}

TEST(SampleAlbedo, CellsHoldAllOfTheProjectedHemisphere) {
    double sum = 0;
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) sum += projectedSolidAngle(cell);
    EXPECT_NEAR(sum, kPi, 1e-12);
}

TEST(SampleAlbedo, IsExactForAUniformSampleAndSaysWhatItMissed) {
    const Albedo albedo = directionalAlbedo(uniform(0.3 / kPi));
    const double seen = std::pow(sin(75_deg), 2);
    for (const Band band : kBands) {
        const double times = 1.0 + static_cast<double>(index(band));  // of test::ledTable
        EXPECT_NEAR(albedo[band].value, times * 0.3 * seen, 1e-12);
        EXPECT_NEAR(albedo[band].missing, 1 - seen, 1e-12);
    }
}

TEST(SampleAlbedo, FillsWhatIsMissingWithAnswersAndTheirUncertainty) {
    const LedTable led = uniform(0.3 / kPi);
    const test::Made known([](const LightView&) {
        Answer answer = test::answerOf(0.3 / kPi);
        answer.uRandom = LedBands::all(0);
        answer.uSystematic = LedBands::all(0.01 / kPi);
        return answer;
    });
    const BandAlbedo cells = directionalAlbedo(led)[Band::R];
    const BandAlbedo whole = filledAlbedo(led, known)[Band::R];
    EXPECT_NEAR(whole.value, 0.3, 1e-12);
    EXPECT_NEAR(whole.missing, 0, 1e-12);
    EXPECT_NEAR(*whole.uRandom, *cells.uRandom, 1e-15);
    EXPECT_NEAR(*whole.uSystematic, *cells.uSystematic + 0.01 * cells.missing, 1e-12);

    const test::Made unknown([](const LightView&) { return test::answerOf(0.3 / kPi); });
    EXPECT_NEAR(filledAlbedo(led, unknown)[Band::R].value, 0.3, 1e-12);
    EXPECT_FALSE(filledAlbedo(led, unknown)[Band::R].u());
    const test::Made silent(
        [](const LightView&) { return Answer::none({Flag::Blocked}, Source::Model); });
    EXPECT_EQ(filledAlbedo(led, silent)[Band::R].value, cells.value);
    EXPECT_NEAR(filledAlbedo(led, silent)[Band::R].missing, cells.missing, 1e-12);
}

TEST(SampleAlbedo, UncertaintyIsThatOfManySamplesDrawn) {
    // Draws of every cell's random error and of one systematic error: the spread of their albedos.
    const LedTable led = uniform(0.3 / kPi);
    const BandAlbedo albedo = directionalAlbedo(led)[Band::R];
    std::mt19937_64 random(7);
    std::normal_distribution<double> unit;
    constexpr int kDraws = 300;
    double squaresRandom = 0, squaresSystematic = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
        double independent = 0, common = 0;
        const double shared = unit(random);
        const CellSamples& cells = led.bands[0];
        for (std::size_t cell = 0; cell < cells.size(); ++cell) {
            if (!cells.present(cell)) continue;
            independent += projectedSolidAngle(cell) * cells.uRandom[cell] * unit(random);
            common += projectedSolidAngle(cell) * cells.uSystematic[cell] * shared;
        }
        squaresRandom += independent * independent;
        squaresSystematic += common * common;
    }
    // The standard deviation of a variance of 300 draws is 8 %, of its root 4 %: four of them.
    EXPECT_NEAR(std::sqrt(squaresRandom / kDraws) / *albedo.uRandom, 1, 0.16);
    EXPECT_NEAR(std::sqrt(squaresSystematic / kDraws) / *albedo.uSystematic, 1, 0.16);
    EXPECT_LT(*albedo.uRandom, *albedo.uSystematic / 50);
}

TEST(SampleAlbedo, OfOneCellIsThatCell) {
    LedTable led = uniform(0.3 / kPi);
    for (auto& cells : led.bands) {
        const CellSamples all = cells;
        cells = CellSamples::missing(all.size());
        cells.f[500] = -0.2;  // noise may be negative
        cells.uRandom[500] = 0.1;
        cells.uSystematic[500] = 0.05;
        cells.flags[500] = Flags{Flag::Measured};
    }
    const Albedo albedo = directionalAlbedo(led);
    const double projected = projectedSolidAngle(500);
    EXPECT_DOUBLE_EQ(albedo[Band::G].value, -0.2 * projected);
    EXPECT_DOUBLE_EQ(*albedo[Band::G].uRandom, 0.1 * projected);
    EXPECT_DOUBLE_EQ(*albedo[Band::G].uSystematic, 0.05 * projected);
    EXPECT_NEAR(albedo[Band::G].missing, 1 - projected / kPi, 1e-12);
}

TEST(SampleAlbedo, LeavesOutWhatIsBlockedOrSaturated) {
    const Albedo clean = directionalAlbedo(uniform(0.3 / kPi));
    LedTable led = uniform(0.3 / kPi);
    for (auto& cells : led.bands) {
        for (const auto& [cell, flag] :
             {std::pair(500U, Flag::Blocked), std::pair(501U, Flag::Saturated)}) {
            cells.f[cell] = 1e6;
            cells.flags[cell].set(flag);
        }
    }
    const Albedo albedo = directionalAlbedo(led);
    const double out = projectedSolidAngle(500) + projectedSolidAngle(501);
    EXPECT_NEAR(albedo[Band::R].value, clean[Band::R].value - 0.3 / kPi * out, 1e-12);
    EXPECT_NEAR(albedo[Band::R].missing, clean[Band::R].missing + out / kPi, 1e-12);
}

TEST(SampleAlbedo, OfABandThatWasNotMeasuredIsNan) {
    LedTable led = uniform(0.3 / kPi);
    led.bands[1] = {};
    led.bands[2] = CellSamples::missing(CellGrid::count());
    const Albedo albedo = directionalAlbedo(led);
    EXPECT_GT(albedo[Band::R].value, 0);
    for (const Band band : {Band::G, Band::B}) {
        EXPECT_TRUE(std::isnan(albedo[band].value));
        EXPECT_EQ(albedo[band].missing, 1);
    }
}

TEST(SampleMeanAlbedo, IsExactForAUniformSampleWithinTheIncidencesSeen) {
    const SampleSet set = test::sampleSet([](Radians, const Direction&) { return 0.3 / kPi; });
    const BandAlbedo mean = meanAlbedo(set)[Band::R];
    // sin^2 of 0..60 degrees in, of 0..75 degrees out.
    const double seen = 0.75 * std::pow(sin(75_deg), 2);
    EXPECT_NEAR(mean.value, 0.3 * seen, 1e-12);
    EXPECT_NEAR(mean.missing, 1 - seen, 1e-12);
    EXPECT_NEAR(mean.errorBound, 0, 1e-12);
    EXPECT_NEAR(*mean.uSystematic, 0.02 * 0.3 * seen, 1e-12);
    EXPECT_LT(*mean.uRandom, *mean.uSystematic / 50);
}

TEST(SampleMeanAlbedo, HasAnErrorBoundWhereTheIncidencesDiffer) {
    const SampleSet set = test::sampleSet([](Radians incidence, const Direction&) {
        return (0.2 + 0.3 * std::pow(sin(incidence), 4)) / kPi;
    });
    const BandAlbedo mean = meanAlbedo(set)[Band::R];
    const double outgoing = std::pow(sin(75_deg), 2);
    // integral of 0.2 + 0.3 s^2 over s in 0..0.75
    const double truth = (0.2 * 0.75 + 0.1 * std::pow(0.75, 3)) * outgoing;
    EXPECT_GT(mean.errorBound, 1e-4);
    EXPECT_NEAR(mean.value, truth, mean.errorBound);
}

TEST(SampleMeanAlbedo, OfOneIncidenceIsNotKnown) {
    SampleSet set = test::sampleSet([](Radians, const Direction&) { return 0.3 / kPi; });
    set.leds.resize(2);
    EXPECT_TRUE(std::isfinite(meanAlbedo(set)[Band::G].value));
    EXPECT_TRUE(std::isnan(meanAlbedo(set)[Band::G].errorBound));
    set.leds.push_back(set.leds.back());
    EXPECT_TRUE(std::isfinite(meanAlbedo(set)[Band::G].value));
    EXPECT_TRUE(std::isnan(meanAlbedo(set)[Band::G].errorBound)) << "two share an incidence";
    set.leds.resize(1);
    EXPECT_TRUE(std::isnan(meanAlbedo(set)[Band::G].value));
    EXPECT_EQ(meanAlbedo(set)[Band::G].missing, 1);
}

}  // namespace
}  // namespace gonio::proc
