#include "proc/calibrate/two_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace gonio::proc {
namespace {

constexpr double kGain = 3e6;   // electrons per second per f
constexpr double kStray = 900;  // electrons per second

const Direction kLight = Direction::fromSpherical(40_deg, 0_deg);

/// S = g f + s in all rows below 75, with this relative noise.
template <class F>
CellSignal signalOf(const F& f, double relativeNoise = 1e-3) {
    CellSignal signal = CellSignal::missing(CellGrid::count());
    for (std::size_t cell = 0; cell < signal.size(); ++cell) {
        if (CellGrid::place(cell).row >= 75) {
            signal.flags[cell].set(Flag::Blocked);
            continue;
        }
        signal.signal[cell] = kGain * f(CellGrid::centre(cell)) + kStray;
        signal.variance[cell] = std::pow(relativeNoise * signal.signal[cell], 2);
        signal.nEff[cell] = 40;
        signal.flags[cell].set(Flag::Measured);
    }
    return signal;
}

/// White and black as their certificates say, seen by the same rig.
struct Tiles {
    ReferenceTable white = ReferenceTable::lambertian("white", 0.98, 0.005);
    ReferenceTable black = ReferenceTable::lambertian("black", 0.001, 0.1);
    CellSignal whiteSignal = signalOf([](const Direction&) { return 0.98 / kPi; });
    CellSignal blackSignal = signalOf([](const Direction&) { return 0.001 / kPi; });

    [[nodiscard]] Calibrated operator()(const CellSignal& sample,
                                        Radians uAngle = 0_deg,
                                        double ledDrift = 0) const {
        const std::vector angle(CellGrid::count(), DirectionSpread::even(uAngle));
        return calibrate(
            sample, {whiteSignal, blackSignal, white, black}, kLight, Band::G, {angle, ledDrift});
    }
};

double slanted(const Direction& wo) { return 0.1 + 0.05 * wo.x(); }

TEST(TwoPoint, TakesGainAndStrayLightOut) {
    const Tiles tiles;
    const Calibrated out = tiles(signalOf(slanted));
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        if (CellGrid::place(cell).row >= 75) {
            ASSERT_FALSE(out.samples.present(cell));
            ASSERT_TRUE(out.samples.flags[cell].has(Flag::Blocked));
            ASSERT_TRUE(std::isnan(out.samples.f[cell]));
            continue;
        }
        ASSERT_TRUE(out.samples.present(cell));
        ASSERT_NEAR(out.samples.f[cell], slanted(CellGrid::centre(cell)), 1e-12);
        ASSERT_EQ(out.samples.nEff[cell], 40);
    }
}

TEST(TwoPoint, RandomUncertaintyIsThatOfRepeats) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise;
    const Tiles clean;
    const CellSignal sample = signalOf(slanted, 0.01);
    Tiles tiles = clean;
    CellSignal noisy = sample;
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        const auto disturb = [&](CellSignal& s) {
            s.signal[cell] += noise(random) * std::sqrt(s.variance[cell]);
        };
        disturb(noisy);
        disturb(tiles.whiteSignal);
        disturb(tiles.blackSignal);
    }
    const Calibrated out = tiles(noisy);
    double sum = 0;
    double count = 0;
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        if (!out.samples.present(cell)) continue;
        const double error = out.samples.f[cell] - slanted(CellGrid::centre(cell));
        sum += std::pow(error / out.samples.uRandom[cell], 2);
        ++count;
    }
    EXPECT_NEAR(sum / count, 1, 0.05);
}

TEST(TwoPoint, SystematicUncertaintyIsWhatATileThatLiesDoes) {
    // White brighter by one sigma than its certificate: f comes out lower by what u_systematic
    // says.
    const auto shifted = [](double whiteFactor, double blackFactor) {
        Tiles tiles;
        tiles.whiteSignal = signalOf([=](const Direction&) { return 0.98 / kPi * whiteFactor; });
        tiles.blackSignal = signalOf([=](const Direction&) { return 0.001 / kPi * blackFactor; });
        return tiles(signalOf(slanted)).samples;
    };
    const CellSamples right = shifted(1, 1);
    const CellSamples white = shifted(1.005, 1);
    const CellSamples black = shifted(1, 1.1);
    for (const double theta : {5.5, 40.5, 70.5}) {
        const std::size_t cell =
            *CellGrid::cellAt(Direction::fromSpherical(Radians::fromDegrees(theta), 30_deg));
        const double both =
            std::hypot(white.f[cell] - right.f[cell], black.f[cell] - right.f[cell]);
        EXPECT_NEAR(both / right.uSystematic[cell], 1, 0.02) << theta;
    }
}

/// All signals of a capture whose LED gave so much of its light; the stray light is the LED's too.
CellSignal scaled(CellSignal signal, double output) {
    for (double& s : signal.signal) s *= output;
    return signal;
}

TEST(TwoPoint, LedDriftIsWhatThreeCapturesOfAnUnsteadyLedDo) {
    constexpr double kDrift = 0.002;
    const Tiles tiles;
    for (const double level : {1.0, 1e-3}) {  // as bright as white, and nearly black
        const CellSignal sample =
            signalOf([=](const Direction& wo) { return level * slanted(wo); });
        const CellSamples right = tiles(sample).samples;
        const CellSamples budgeted = tiles(sample, 0_deg, kDrift).samples;
        Tiles unsteadyWhite = tiles, unsteadyBlack = tiles;
        unsteadyWhite.whiteSignal = scaled(tiles.whiteSignal, 1 + kDrift);
        unsteadyBlack.blackSignal = scaled(tiles.blackSignal, 1 + kDrift);
        const CellSamples one = tiles(scaled(sample, 1 + kDrift)).samples;
        const CellSamples two = unsteadyWhite(sample).samples;
        const CellSamples three = unsteadyBlack(sample).samples;
        for (const double theta : {5.5, 40.5, 70.5}) {
            const std::size_t cell =
                *CellGrid::cellAt(Direction::fromSpherical(Radians::fromDegrees(theta), 30_deg));
            const double all = std::hypot(one.f[cell] - right.f[cell],
                                          two.f[cell] - right.f[cell],
                                          three.f[cell] - right.f[cell]);
            const double added = std::sqrt(std::pow(budgeted.uSystematic[cell], 2) -
                                           std::pow(right.uSystematic[cell], 2));
            EXPECT_NEAR(added / all, 1, 0.01) << level << ' ' << theta;  // first order: 0.2 %
        }
    }
}

TEST(TwoPoint, LedDriftCountsTwiceForBrightSamplesAndIsNotRandom) {
    constexpr double kDrift = 0.002;
    const Tiles tiles;
    const CellSignal sample = signalOf([](const Direction&) { return 0.3; });
    const Calibrated with = tiles(sample, 0_deg, kDrift);
    const Calibrated without = tiles(sample);
    const auto driftOf = [](const Calibrated& calibrated) {
        return *std::find_if(calibrated.budget.begin(),
                             calibrated.budget.end(),
                             [](const BudgetComponent& one) { return one.name == "LED drift"; });
    };
    const BudgetComponent drift = driftOf(with);
    EXPECT_EQ(drift.name, "LED drift");
    EXPECT_EQ(drift.type, 'B');
    EXPECT_EQ(drift.correlation, Correlation::PerState);
    // Black and stray light are 1/500 of it.
    EXPECT_NEAR(drift.medianRelative / (std::sqrt(2) * kDrift), 1, 0.005);
    EXPECT_EQ(driftOf(without).medianRelative, 0);
    const std::size_t cell = 5000;
    EXPECT_EQ(with.samples.uRandom[cell], without.samples.uRandom[cell]);
    EXPECT_EQ(with.samples.f[cell], without.samples.f[cell]);
}

/// The mean over two boxes of a pixel's side of a lobe that is exp(-x^2 / 2 s^2) along theta.
TEST(TwoPoint, PixelsBlurALobeByWhatTheirSizeIsBudgetedFor) {
    constexpr double kWidth = 2 * kPi / 180;
    const Tiles tiles;
    const Radians middle = 40.5_deg;
    CellSignal sample = signalOf([&](const Direction& wo) {
        const double off = (wo.theta() - middle).value() / kWidth;
        return std::exp(-off * off / 2);
    });
    const CellSamples sharp = tiles(sample).samples;
    const double side = 0.2 * kPi / 180;
    sample.pixelSolidAngle = side * side;
    const CellSamples blurred = tiles(sample).samples;
    const std::size_t cell =
        *CellGrid::cellAt(Direction::fromSpherical(middle, Radians::fromDegrees(50)));
    const double added =
        std::sqrt(std::pow(blurred.uSystematic[cell], 2) - std::pow(sharp.uSystematic[cell], 2));
    // A Gaussian of variance s^2 + p^2 / 6 is lower by this at its top.
    const double loss = 1 - 1 / std::sqrt(1 + side * side / (6 * kWidth * kWidth));
    EXPECT_NEAR(added / sharp.f[cell], loss, 0.02 * loss);
    EXPECT_EQ(blurred.f[cell], sharp.f[cell]);
}

TEST(TwoPoint, GlareIsWhatThreeSignalsOfThatErrorDo) {
    const Tiles tiles;
    const auto raised = [](CellSignal signal, double error, bool known) {
        for (std::size_t cell = 0; cell < signal.size(); ++cell) {
            if (known) signal.uGlare[cell] = error;
            if (!known) signal.signal[cell] += error;
        }
        return signal;
    };
    for (const double level : {1e-3, 1.0}) {
        const CellSignal sample =
            signalOf([=](const Direction& wo) { return level * slanted(wo); });
        const CellSamples right = tiles(sample).samples;
        Tiles budgeted = tiles, white = tiles, black = tiles;
        budgeted.whiteSignal = raised(tiles.whiteSignal, 3000, true);
        budgeted.blackSignal = raised(tiles.blackSignal, 100, true);
        white.whiteSignal = raised(tiles.whiteSignal, 3000, false);
        black.blackSignal = raised(tiles.blackSignal, 100, false);
        const Calibrated known = budgeted(raised(sample, 500, true));
        const CellSamples one = tiles(raised(sample, 500, false)).samples;
        const CellSamples two = white(sample).samples;
        const CellSamples three = black(sample).samples;
        const std::size_t cell = 5000;
        const double all = std::hypot(one.f[cell] - right.f[cell],
                                      two.f[cell] - right.f[cell],
                                      three.f[cell] - right.f[cell]);
        const double added = std::sqrt(std::pow(known.samples.uSystematic[cell], 2) -
                                       std::pow(right.uSystematic[cell], 2));
        EXPECT_NEAR(added / all, 1, 0.01) << level;
        EXPECT_EQ(known.samples.f[cell], right.f[cell]);
    }
}

TEST(TwoPoint, GeometryIsSlopeTimesAngle) {
    const Tiles tiles;
    const Radians u = 0.5_deg;
    const Calibrated out = tiles(signalOf(slanted), u);
    const Calibrated ideal = tiles(signalOf(slanted));
    const std::size_t cell = *CellGrid::cellAt(Direction::fromSpherical(30.5_deg, 0.7_deg));
    const double added = std::sqrt(std::pow(out.samples.uSystematic[cell], 2) -
                                   std::pow(ideal.samples.uSystematic[cell], 2));
    // d(0.05 x)/dtheta = 0.05 cos(theta).
    EXPECT_NEAR(added, 0.05 * cos(30.5_deg) * u.value(), 1e-5);
}

/// White, and a light trap of this f, seen by the same rig.
Calibrated withTrap(const CellSignal& sample, double whiteFactor, double trap) {
    const ReferenceTable white = ReferenceTable::lambertian("white", 0.98, 0.005);
    const ReferenceTable zero = ReferenceTable::lightTrap("zero", 1e-5);
    const CellSignal whiteSignal =
        signalOf([=](const Direction&) { return 0.98 / kPi * whiteFactor; });
    const CellSignal zeroSignal = signalOf([=](const Direction&) { return trap; });
    const std::vector<DirectionSpread> angle(CellGrid::count());
    return calibrate(
        sample, {whiteSignal, zeroSignal, white, zero}, kLight, Band::G, {.angle = angle});
}

TEST(TwoPoint, AZeroReferenceTakesTheBlacksPlace) {
    for (const double level : {1e-3, 1e-2, 0.3}) {
        const CellSignal sample = signalOf([=](const Direction&) { return level; });
        const CellSamples right = withTrap(sample, 1, 0).samples;
        const CellSamples trapOff = withTrap(sample, 1, 1e-5).samples;
        const CellSamples whiteOff = withTrap(sample, 1.005, 0).samples;
        const CellSamples black = Tiles()(sample).samples;
        const std::size_t cell = 5000;
        EXPECT_NEAR(right.f[cell], level, 1e-12);
        const double both =
            std::hypot(trapOff.f[cell] - right.f[cell], whiteOff.f[cell] - right.f[cell]);
        EXPECT_NEAR(both / right.uSystematic[cell], 1, 0.01) << level;
        EXPECT_LE(right.uSystematic[cell], 1.001 * black.uSystematic[cell]) << level;
    }
    const Budget budget = withTrap(signalOf(slanted), 1, 0).budget;
    const auto has = [&](const std::string& name) {
        return std::any_of(
            budget.begin(), budget.end(), [&](const auto& one) { return one.name == name; });
    };
    EXPECT_TRUE(has("zero reference"));
    EXPECT_TRUE(has("noise of the zero reference's frames"));
    EXPECT_FALSE(has("black reference"));
}

TEST(TwoPoint, NegativeValuesSurviveAndAreBelowNoise) {
    const Tiles tiles;
    const Calibrated out = tiles(signalOf([](const Direction&) { return -0.0001; }, 1));
    const std::size_t cell = *CellGrid::cellAt(Direction::fromSpherical(30.5_deg, 10_deg));
    EXPECT_NEAR(out.samples.f[cell], -0.0001, 1e-12);
    EXPECT_TRUE(out.samples.flags[cell].has(Flag::BelowNoise));
    EXPECT_TRUE(out.samples.present(cell));
}

TEST(TwoPoint, WithoutContrastNothingIsSaid) {
    Tiles tiles;
    tiles.whiteSignal = tiles.blackSignal;
    const Calibrated out = tiles(signalOf(slanted));
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        ASSERT_FALSE(out.samples.present(cell));
        ASSERT_TRUE(std::isnan(out.samples.f[cell]));
    }
}

TEST(TwoPoint, AMissingReferenceCellIsMissing) {
    Tiles tiles;
    const std::size_t cell = 5000;
    tiles.whiteSignal.flags[cell] = {Flag::Saturated};
    const Calibrated out = tiles(signalOf(slanted));
    EXPECT_FALSE(out.samples.present(cell));
    EXPECT_TRUE(out.samples.flags[cell].has(Flag::Saturated));
    EXPECT_TRUE(out.samples.present(cell + 1));
    EXPECT_TRUE(std::isfinite(out.samples.uSystematic[cell + 1]));
}

TEST(TwoPoint, BudgetNamesEveryComponent) {
    const Tiles tiles;
    const Budget budget = tiles(signalOf(slanted), 0.1_deg, 0.002).budget;
    ASSERT_EQ(budget.size(), 12U);
    for (const BudgetComponent& component : budget) {
        EXPECT_TRUE(component.type == 'A' || component.type == 'B');
        EXPECT_FALSE(name(component.correlation).empty());
        if (component.name == "white reference, common") {
            EXPECT_NEAR(component.medianRelative, 0.005, 5e-5);
            EXPECT_EQ(component.correlation, Correlation::Common);
            EXPECT_EQ(component.size, 0.005);
            EXPECT_NEAR(component.sensitivity(), 1, 0.01);
        } else if (component.size == 0) {  // not known of these tiles and this rig
            EXPECT_EQ(component.medianRelative, 0) << component.name;
            EXPECT_EQ(component.sensitivity(), 0) << component.name;
        } else {
            EXPECT_GT(component.medianRelative, 0) << component.name;
        }
    }
}

TEST(TwoPoint, BudgetLineIsSensitivityTimesSize) {
    const Tiles tiles;
    const std::vector angle(CellGrid::count(), DirectionSpread::even(0.1_deg));
    const CellSignal sample = signalOf([](const Direction&) { return 0.3; });
    const Calibrated out =
        calibrate(sample,
                  {tiles.whiteSignal, tiles.blackSignal, tiles.white, tiles.black},
                  kLight,
                  Band::G,
                  {.angle = angle, .exposureRatio = 0.002, .linearity = 0.003, .angleFreedom = 58});
    const auto line = [&](const std::string& name) {
        return *std::find_if(out.budget.begin(), out.budget.end(), [&](const auto& component) {
            return component.name == name;
        });
    };
    // As drift: once for the sample and once for white; black and stray light are 1/500 of it.
    EXPECT_NEAR(line("exposure ratio").sensitivity(), std::sqrt(2), 0.01);
    EXPECT_NEAR(line("linearity").medianRelative, std::sqrt(2) * 0.003, 3e-5);
    EXPECT_NEAR(
        line("black reference").sensitivity(), 0.001 / kPi / 0.3 * (1 - 0.3 * kPi / 0.98), 1e-5);
    EXPECT_NEAR(line("noise of the sample's frames").size, 1e-3, 1e-6);
    EXPECT_NEAR(line("noise of the sample's frames").sensitivity(), 1, 0.01);
    EXPECT_NEAR(line("direction of the cell (lens map)").size, 0.1, 1e-12);
    EXPECT_EQ(line("direction of the cell (lens map)").unit, "degree");
    EXPECT_EQ(line("direction of the cell (lens map)").freedom, 58);
    EXPECT_FALSE(line("linearity").freedom);
}

TEST(TwoPoint, MonteCarloOnRequestAgreesWithFirstOrder) {
    const Tiles tiles;
    const std::vector angle(CellGrid::count(), DirectionSpread::even(0.05_deg));
    const CellSignal sample = signalOf(slanted);
    const auto with = [&](const MonteCarlo& monteCarlo) {
        return calibrate(sample,
                         {tiles.whiteSignal, tiles.blackSignal, tiles.white, tiles.black},
                         kLight,
                         Band::G,
                         {.angle = angle, .ledDrift = 0.002},
                         monteCarlo);
    };
    const Calibrated first = with({}), drawn = with({.draws = 400, .seed = 3});
    EXPECT_EQ(first.propagated, 0U);
    double sum = 0;
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        if (!first.samples.present(cell)) continue;
        ASSERT_EQ(first.samples.f[cell], drawn.samples.f[cell]);
        const double ratio = drawn.samples.at(cell).u() / first.samples.at(cell).u();
        ASSERT_NEAR(ratio, 1, 0.3);  // 4.8 % of scatter in one cell, six of these
        sum += ratio;
    }
    EXPECT_NEAR(sum / static_cast<double>(drawn.propagated), 1, 0.01);
}

TEST(TwoPoint, MonteCarloTakesOverOnASteepFlankByItself) {
    // 2 per degree over four degrees, even beside them.
    const auto flank = [](const Direction& wo) {
        return 0.1 * std::exp(2 * std::clamp(wo.theta().degrees() - 40.5, -4.0, 0.0));
    };
    const Tiles tiles;
    const Calibrated out = tiles(signalOf(flank), 0.2_deg);
    EXPECT_GT(out.propagated, 0U);
    const std::size_t steep = *CellGrid::cellAt(Direction::fromSpherical(38.5_deg, 10_deg));
    const std::size_t even = *CellGrid::cellAt(Direction::fromSpherical(60.5_deg, 10_deg));
    // ln f is off by 0.4 sigma: 95 % of exp(0.4 z) lie within 0.931 of 1. Six times the 2.1 % by
    // which 2000 draws scatter.
    EXPECT_NEAR(out.samples.uSystematic[steep] / out.samples.f[steep], 0.931 / 1.96, 0.06);
    EXPECT_LT(out.samples.uSystematic[even] / out.samples.f[even], 0.01);
}

TEST(TwoPoint, WithoutContrastItIsFlagged) {
    Tiles tiles;
    tiles.whiteSignal = tiles.blackSignal;
    const Calibrated out = tiles(signalOf(slanted));
    EXPECT_TRUE(out.samples.flags[100].has(Flag::BelowNoise));
}

}  // namespace
}  // namespace gonio::proc
