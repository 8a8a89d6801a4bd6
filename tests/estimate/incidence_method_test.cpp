#include "proc/estimate/incidence_method.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/estimate/coverage.h"
#include "proc/estimate/reciprocal_method.h"
#include "proc/optics/cell_grid.h"
#include "tests/support/random_directions.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

const std::vector<bool> kAll(4, true);

const std::vector<IncidenceFrame> kFrames{IncidenceFrame::SameDirection,
                                          IncidenceFrame::SpecularRelative,
                                          IncidenceFrame::DirectionCosine,
                                          IncidenceFrame::HalfVector};
const std::vector<SheetQuantity> kQuantities{
    SheetQuantity::F, SheetQuantity::LogF, SheetQuantity::LogFCosines};

LightView pairOf(double thetaI, double thetaO, double phiO) {
    return {
        .in = Direction::fromSpherical(Radians::fromDegrees(thetaI), 0_deg),
        .out = Direction::fromSpherical(Radians::fromDegrees(thetaO), Radians::fromDegrees(phiO))};
}

TEST(IncidenceFrame, MovesTheMirrorDirectionToTheMirrorDirection) {
    for (const IncidenceFrame frame : kFrames) {
        if (frame == IncidenceFrame::SameDirection) continue;
        const Direction moved = onSheet(frame, pairOf(30, 30, 180), 40_deg);
        EXPECT_NEAR(moved.theta().degrees(), 40, 1e-9);
        EXPECT_NEAR(moved.phi().degrees(), 180, 1e-9);
    }
}

TEST(IncidenceFrame, StaysWhereItIsOnItsOwnSheet) {
    for (const IncidenceFrame frame : kFrames) {
        const LightView pair = pairOf(40, 57, 123);
        const Direction same = onSheet(frame, pair, 40_deg);
        EXPECT_LT((same.vector() - pair.out.vector()).norm(), 1e-12);
    }
}

TEST(IncidenceFrame, NeverFallsBelowTheHorizon) {
    for (const IncidenceFrame frame : kFrames) {
        for (const double theta : {0.0, 45.0, 80.0, 89.9}) {
            for (const double phi : {0.0, 90.0, 180.0}) {
                for (const Radians sheet : {0_deg, 60_deg}) {
                    EXPECT_GT(onSheet(frame, pairOf(89, theta, phi), sheet).z(), 0.008);
                }
            }
        }
    }
}

TEST(SheetMethod, ReproducesAConstantBetweenAndBeyond) {
    const auto data = fitDataOf(test::sampleSet([](Radians, const Direction&) { return 0.2; }));
    for (const IncidenceFrame frame : kFrames) {
        for (const IncidenceCurve curve : {IncidenceCurve::Linear, IncidenceCurve::CatmullRom}) {
            const auto method =
                sheetMethod(data, kAll, {.name = "x", .frame = frame, .curve = curve});
            for (const double thetaI : {0.0, 7.0, 20.0, 33.0, 59.0, 60.0, 75.0}) {
                const MethodAnswer answer = method->at(pairOf(thetaI, 50, 77));
                EXPECT_NEAR(answer.f[Band::R], 0.2, 1e-12);
                EXPECT_NEAR(answer.f[Band::B], 0.6, 1e-12);
            }
        }
    }
}

TEST(SheetMethod, ReproducesWhatIsLinearInIncidence) {
    const auto data = fitDataOf(test::sampleSet(
        [](Radians incidence, const Direction&) { return 0.1 + incidence.degrees() / 100; }));
    for (const IncidenceCurve curve : {IncidenceCurve::Linear, IncidenceCurve::CatmullRom}) {
        const auto method = sheetMethod(
            data, kAll, {.name = "x", .frame = IncidenceFrame::SameDirection, .curve = curve});
        EXPECT_NEAR(method->at(pairOf(33, 20, 5)).f[Band::R], 0.43, 1e-12);
        EXPECT_NEAR(method->at(pairOf(5, 20, 5)).f[Band::R], 0.15, 1e-12);
    }
}

TEST(SheetMethod, AnswersACellAtItsOwnIncidenceInEveryQuantity) {
    const auto set = test::sampleSet([](Radians incidence, const Direction& wo) {
        return 0.01 + wo.z() * (1 + incidence.value()) + 50 * std::pow(wo.z(), 400);
    });
    const auto data = fitDataOf(set);
    for (const SheetQuantity quantity : kQuantities) {
        const auto method = sheetMethod(data, kAll, {.name = "x", .quantity = quantity});
        for (const std::size_t cell : {std::size_t{0}, std::size_t{999}, std::size_t{15000}}) {
            const LightView pair{.in = Direction::fromSpherical(40_deg, 0_deg),
                                 .out = CellGrid::centre(cell)};
            const double f = set.leds[2].bands[1].f[cell];
            const MethodAnswer answer = method->at(pair);
            EXPECT_NEAR(answer.f[Band::G], f, 1e-9 * f);
            EXPECT_NEAR(answer.uRandom[Band::G], set.leds[2].bands[1].uRandom[cell], 1e-9 * f);
        }
    }
}

TEST(SheetMethod, KeepsZeroAndNegativeValues) {
    for (const double value : {0.0, -3e-4}) {
        auto set = test::sampleSet([&](Radians, const Direction&) { return value; });
        for (LedTable& led : set.leds) {
            for (CellSamples& cells : led.bands) {
                for (std::size_t i = 0; i < cells.size(); ++i) cells.uRandom[i] = 1e-3;
            }
        }
        const auto data = fitDataOf(set);
        for (const SheetQuantity quantity : kQuantities) {
            const auto method = sheetMethod(data, kAll, {.name = "x", .quantity = quantity});
            // Constant f is not constant times the cosines.
            const double slack = quantity == SheetQuantity::LogFCosines ? 0.1 : 1e-9;
            EXPECT_NEAR(method->at(pairOf(31, 22, 40)).f[Band::R], value, slack * std::abs(value));
        }
    }
}

TEST(ReciprocalAnswer, IsTheSameBothWays) {
    const auto data = fitDataOf(test::sampleSet([](Radians incidence, const Direction& wo) {
        return 0.1 + 0.3 * incidence.value() * wo.x() * wo.x() + 0.2 * wo.z();
    }));
    const auto method = sheetMethod(data, kAll, {.name = "x"});
    const Coverage coverage(data, kAll);
    std::mt19937_64 random(7);
    for (int i = 0; i < 200; ++i) {
        const LightView pair{.in = test::randomDirection(random),
                             .out = test::randomDirection(random)};
        const auto there = reciprocalAnswer(*method, coverage, pair);
        const auto back = reciprocalAnswer(*method, coverage, {.in = pair.out, .out = pair.in});
        EXPECT_NEAR(there.value.f[Band::R], back.value.f[Band::R], 1e-9);
        EXPECT_NEAR(there.ways[0].exchanged, 1 - back.ways[0].exchanged, 1e-9);
    }
}

TEST(ReciprocalAnswer, GainsNothingFromTheSameCellsAskedTwice) {
    auto set = test::sampleSet([](Radians, const Direction&) { return 0.2; });
    for (LedTable& led : set.leds) {
        for (CellSamples& cells : led.bands) {
            for (std::size_t i = 0; i < cells.size(); ++i) cells.uRandom[i] = 0.01;
        }
    }
    const auto data = fitDataOf(set);
    const auto method = sheetMethod(data, kAll, {.name = "x"});
    const Coverage coverage(data, kAll);
    // The mirror direction is its own exchange.
    const LightView mirror = pairOf(30, 30, 180);
    const double once = method->at(mirror).uRandom[Band::R];
    EXPECT_NEAR(reciprocalAnswer(*method, coverage, mirror).value.uRandom[Band::R], once, 1e-9);
    const LightView apart = pairOf(30, 30, 90);
    EXPECT_NEAR(reciprocalAnswer(*method, coverage, apart).value.uRandom[Band::R],
                method->at(apart).uRandom[Band::R] / std::sqrt(2.0),
                1e-4);
}

TEST(Coverage, TellsHowFarAPairIsFromWhatWasMeasured) {
    const auto data = fitDataOf(test::sampleSet([](Radians, const Direction&) { return 1.0; }));
    const Coverage coverage(data, kAll);
    EXPECT_TRUE(coverage.at(pairOf(40, 30, 10))[0].within());
    EXPECT_NEAR(coverage.at(pairOf(40, 30, 10))[0].between, 0, 1e-12);
    EXPECT_NEAR(coverage.at(pairOf(30, 30, 10))[0].between, 1, 1e-9);
    EXPECT_NEAR(coverage.at(pairOf(70, 30, 10))[0].beyondIncidence.degrees(), 10, 1e-9);
    EXPECT_NEAR(coverage.at(pairOf(40, 79.5, 0))[0].steps, 5, 0.01);
    EXPECT_FALSE(coverage.at(pairOf(40, 79.5, 0))[0].within());
}

TEST(Coverage, TellsTheBandsApart) {
    auto set = test::sampleSet([](Radians, const Direction&) { return 1.0; });
    const LightView pair = pairOf(40, 30, 10);
    for (std::size_t i = 0; i < CellGrid::count(); ++i) {
        const LightView to{.in = pair.out, .out = CellGrid::centre(i)};
        if (angleBetween(to) < 6_deg) set.leds[2].bands[0].flags[i] = Flags{Flag::Saturated};
    }
    set.leds[1].bands[2] = CellSamples::missing(CellGrid::count());
    const Coverage coverage(fitDataOf(set), kAll);
    const auto reach = coverage.at(pair);
    EXPECT_GT(reach[0].steps, 4);
    EXPECT_TRUE(reach[1].within());
    EXPECT_TRUE(coverage.at(pairOf(20, 30, 10))[0].within());
    EXPECT_NEAR(coverage.at(pairOf(20, 30, 10))[1].between, 0, 1e-12);
    EXPECT_NEAR(coverage.at(pairOf(20, 30, 10))[2].between, 1, 1e-9);
}

TEST(Coverage, OfNothingIsFarFromEverything) {
    const Coverage coverage(BrdfData{}, {});
    EXPECT_FALSE(coverage.at(pairOf(0, 0, 0))[0].within());
}

}  // namespace
}  // namespace gonio::proc
