// What a sample may hold at worst, asked of the default estimator with its choice made: a lobe a
// million times as bright as its floor, one cell gone wild, values of nothing and below, incidences
// of 0 and 90 degrees.

#include <gtest/gtest.h>

#include <cmath>

#include "proc/estimate/interpolation_study.h"
#include "proc/estimate/sample_estimator.h"
#include "proc/models/spec.h"
#include "proc/optics/cell_grid.h"
#include "tests/estimate/made_up.h"

namespace gonio::proc {
namespace {

using test::pairAt;

SampleSet sampleOf(const std::string& spec) {
    return syntheticSample(**makeModel(spec), {.relativeNoise = 0.01});
}

void expectAnswersEverywhere(const SampleSet& set) {
    const auto made = SampleEstimator::over(set, {});
    ASSERT_TRUE(made) << made.error().message;
    // In double precision 90 degrees are a hair above the horizon.
    for (const double thetaI : {0.0, 1e-9, 10.0, 20.0, 59.9, 60.0, 74.0, 90.0}) {
        for (const double thetaO : {0.0, 0.5, 20.0, 74.99, 75.0, 90.0}) {
            for (const double phi : {0.0, 0.5, 180.0, 359.5}) {
                const Answer answer = (*made)->answer(pairAt(thetaI, thetaO, phi));
                ASSERT_TRUE(answer.present()) << thetaI << " " << thetaO << " " << phi;
                for (const Band band : kBands) {
                    ASSERT_TRUE(std::isfinite(answer.f[band])) << thetaI << " " << thetaO;
                    ASSERT_TRUE(answer.u(band) && std::isfinite(*answer.u(band)));
                    EXPECT_GE(*answer.u(band), 0);
                }
            }
        }
    }
}

TEST(EstimatorExtremes, ALobeAMillionTimesItsFloor) {
    // Within the cell of its peak f is 3e5 / sr, 10 degrees beside it below 0.1.
    expectAnswersEverywhere(sampleOf("lambert,albedo=1e-6+ggx,alpha=0.001,f0=0.9"));
}

TEST(EstimatorExtremes, ValuesOfNothingAndBelow) {
    SampleSet set = sampleOf("lambert,albedo=0.05");
    for (LedTable& led : set.leds) {
        for (CellSamples& cells : led.bands) {
            for (std::size_t i = 0; i < cells.size(); ++i) cells.f[i] = i % 3 == 0 ? 0 : -1e-4;
        }
    }
    expectAnswersEverywhere(set);
}

TEST(EstimatorExtremes, OneCellGoneWildStaysOneCell) {
    SampleSet set = sampleOf("lambert,albedo=0.3");
    const std::size_t cell = *CellGrid::cellAt(Direction::fromSpherical(30_deg, 90_deg));
    for (CellSamples& cells : set.leds[2].bands) cells.f[cell] = 1e5;
    const auto made = SampleEstimator::over(set, {});
    ASSERT_TRUE(made) << made.error().message;
    const LightView at40{.in = Direction::fromSpherical(40_deg, 0_deg),
                         .out = CellGrid::centre(cell)};
    EXPECT_EQ((*made)->answer(at40).f[Band::G], 1e5) << "a value is a value";
    for (const LightView& pair : {pairAt(40, 45, 90), pairAt(40, 30, 270), pairAt(10, 30, 90)}) {
        const Answer answer = (*made)->answer(pair);
        EXPECT_NEAR(answer.f[Band::G], 0.3 / kPi, 0.02 * 0.3 / kPi);
    }
}

}  // namespace
}  // namespace gonio::proc
