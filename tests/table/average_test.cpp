#include "proc/table/average.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "proc/table/cell_mean.h"
#include "proc/table/merged_info.h"
#include "proc/table/plane_symmetry.h"
#include "proc/table/reciprocal_average.h"
#include "proc/table/rotations.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

constexpr double kNoise = 0.01, kCommon = 0.005, kLight = 0.003;  // relative
const std::string kBudget =
    R"([{"led":0,"band":"r","components":[
         {"name":"noise","type":"A","correlation":"per cell","median_relative":0.01},
         {"name":"white","type":"B","correlation":"common","median_relative":0.005},
         {"name":"LED drift","type":"B","correlation":"per state","median_relative":0.003}]}])";

double truthAt(const Direction& wo) { return 0.2 + 0.1 * wo.x() + 0.05 * wo.x() * wo.x(); }

/// One LED at 20 degrees, red alone: the truth times what is common, times this capture's light,
/// and noise.
SampleSet capture(std::uint64_t seed, double light = 1) {
    SampleSet set;
    set.info.name = "tile";
    set.info.calibrationId = "1+2+3";
    set.info.budgetJson = kBudget;
    set.leds = {test::ledTable(20_deg, [](Radians, const Direction& wo) { return truthAt(wo); })};
    set.leds[0].bands[1] = set.leds[0].bands[2] = {};
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    CellSamples& cells = set.leds[0].bands[0];
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (!cells.present(i)) continue;
        const double truth = cells.f[i];
        cells.f[i] = truth * (1 + kCommon) * light + kNoise * truth * normal(random);
        cells.uRandom[i] = kNoise * truth;
        cells.uSystematic[i] = std::hypot(kCommon, kLight) * truth;
    }
    return set;
}

const CellSamples& red(const SampleSet& set) { return set.leds[0].bands[0]; }

/// 4 standard deviations of chi-square over its degrees.
double chance(const Consistency& found) {
    return 4 * std::sqrt(2 / static_cast<double>(found.freedom));
}

TEST(CellMean, AveragesWhatIsRandomAndKeepsWhatIsNot) {
    const auto value = [](double f, double random, double systematic) {
        return CellValue{{.value = f, .uRandom = random, .uSystematic = systematic}, random};
    };
    const std::vector<CellValue> values{value(-1, 0.3, 0.1), value(-2, 0.6, 0.2)};
    const CellMean mean = meanOf(values);
    EXPECT_NEAR(mean.mean.value, -1.2, 1e-15);  // weights 4 : 1, and negative stays negative
    EXPECT_NEAR(mean.mean.uRandom, std::hypot(0.8 * 0.3, 0.2 * 0.6), 1e-15);
    EXPECT_NEAR(mean.mean.uSystematic, 0.8 * 0.1 + 0.2 * 0.2, 1e-15);
    EXPECT_NEAR(mean.group.chiSquare, 1 / (0.3 * 0.3 + 0.6 * 0.6), 1e-12);
    EXPECT_EQ(mean.group.freedom, 1U);
    EXPECT_EQ(mean.uRandom(), mean.mean.uRandom);

    const std::vector<CellValue> one{value(-0.25, 0.125, 0.5)};
    EXPECT_EQ(meanOf(one).mean.value, -0.25);
    EXPECT_EQ(meanOf(one).mean.uRandom, 0.125);
    EXPECT_EQ(meanOf(one).group.freedom, 0U);

    // Of three, the one that contradicts counts less; u says that they contradict each other.
    const std::vector<CellValue> off{value(1, 0.01, 0), value(1.01, 0.01, 0), value(2, 0.01, 0)};
    EXPECT_LT(meanOf(off).mean.value, 1.1);
    EXPECT_GT(meanOf(off).away[2], kOutlier);
    EXPECT_GT(meanOf(off).uRandom(), 0.2);

    // What contradicts is the whole of u_apart: sqrt(50 / 1) * 0.02 / sqrt(2), most of it
    // systematic.
    std::vector<CellValue> apart{value(1, 0.001, 0.02), value(1.2, 0.001, 0.02)};
    for (CellValue& each : apart) each.uApart = apartFrom(each.value, 0);
    EXPECT_NEAR(meanOf(apart).uRandom(), 0.1, 1e-3);

    // No uncertainty at all: what is equal agrees.
    const std::vector<CellValue> exact{value(0.5, 0, 0), value(0.5, 0, 0)};
    EXPECT_EQ(meanOf(exact).mean.value, 0.5);
    EXPECT_EQ(meanOf(exact).group.chiSquare, 0);
}

TEST(AverageOf, CapturesOfOneTruthDifferByTheirNoiseAndTheirLight) {
    const std::vector<SampleSet> captures{capture(1), capture(2, 1.004), capture(3, 0.999)};
    const Averaged average = averageOf(captures);
    EXPECT_EQ(2 * average.cells.values, 3 * average.cells.freedom);
    EXPECT_NEAR(average.cells.perFreedom(), 1, chance(average.cells));
    EXPECT_GT(average.cells.probability(), 1e-4);
    ASSERT_EQ(average.states.size(), 3U);
    EXPECT_NEAR(average.states[1].scale / average.states[0].scale, 1.004, 3e-4);
    EXPECT_NEAR(average.states[1].u, kLight / std::sqrt(2.0), 1e-4);
    EXPECT_LT(average.scales.perFreedom(), 4);
    EXPECT_NEAR(average.weightSquares, 1.0 / 3, 0.01);
    for (std::size_t cell = 0; cell < CellGrid::count(); cell += 101) {
        if (!red(average.set).present(cell)) continue;
        const double truth = truthAt(CellGrid::centre(cell));
        const double noise = kNoise * truth / std::sqrt(3.0);
        EXPECT_NEAR(red(average.set).f[cell], truth * (1 + kCommon) * 1.001, 5 * noise);
        EXPECT_NEAR(red(average.set).uRandom[cell], noise, 0.02 * noise);
        EXPECT_NEAR(red(average.set).uSystematic[cell], std::hypot(kCommon, kLight) * truth, 1e-12);
    }
    const std::string budget =
        averagedBudget(average.set, captures, std::sqrt(average.weightSquares));
    EXPECT_NE(budget.find("\"median_relative\":0.0057"), std::string::npos) << budget;
    EXPECT_NE(budget.find("\"median_relative\":0.005}"), std::string::npos) << budget;

    // Of files that were merged of several calibrations nobody knows which calibration is whose.
    std::vector<SampleSet> joint = captures;
    for (SampleSet& set : joint) set.info.calibrationId = "1+2+3; 4+5+6";
    EXPECT_NEAR(averageOf(joint).states[1].u, kLight, 1e-4);

    // Light that changed by 3 % is named, and does not count against the cells.
    std::vector<SampleSet> changed{capture(1), capture(2, 1.03)};
    const Averaged bright = averageOf(changed);
    EXPECT_NEAR(bright.cells.perFreedom(), 1, chance(bright.cells));
    EXPECT_GT(bright.scales.perFreedom(), 20);
    EXPECT_EQ(bright.scales.outliers, 2U);

    // The noisier of two hardly counts in the mean: both are as far from each other all the same.
    for (double& u : changed[1].leds[0].bands[0].uRandom) u *= 10;
    const Averaged uneven = averageOf(changed);
    ASSERT_EQ(uneven.states.size(), 2U);
    const double scale = uneven.states[1].scale / uneven.states[0].scale - 1;
    const double apart = scale / std::hypot(uneven.states[0].u, uneven.states[1].u);
    EXPECT_NEAR(uneven.states[0].away, -apart, 0.02 * apart);
    EXPECT_NEAR(uneven.states[1].away, apart, 0.02 * apart);
    EXPECT_NEAR(uneven.scales.chiSquare, apart * apart, 0.04 * apart * apart);

    // However much it changed, and though a tenth of the cells has dust on it.
    std::vector<SampleSet> far{capture(1), capture(2, 1.2)};
    for (std::size_t cell = 0; cell < CellGrid::count(); cell += 10)
        far[1].leds[0].bands[0].f[cell] *= 1.5;
    const Averaged much = averageOf(far);
    ASSERT_EQ(much.states.size(), 2U);
    EXPECT_NEAR(much.states[1].scale / much.states[0].scale, 1.2, 1e-3);
    EXPECT_EQ(much.scales.outliers, 2U);
    EXPECT_NEAR(static_cast<double>(much.cells.outliers),
                0.2 * static_cast<double>(much.cells.freedom),
                20);
}

/// A budget names its tables by their numbers, which differ from capture to capture.
TEST(MergedInfo, AnAveragesBudgetFollowsTheIncidences) {
    const auto set = [](const std::vector<Radians>& incidences, const std::string& budget) {
        SampleSet made;
        for (const Radians one : incidences)
            made.leds.push_back({.incidence = one, .rotation = {}, .bands = {}});
        made.info.budgetJson = budget;
        return made;
    };
    const std::vector<SampleSet> captures{
        set({40_deg, 20_deg},
            R"([{"led":1,"band":"r","components":[{"name":"white","median_relative":0.25}]},
                {"led":0,"band":"r","components":[{"name":7,"median_relative":0.5}]}])"),
        set({20_deg, 60_deg},
            R"([{"led":0,"band":"r","components":[{"name":"white","median_relative":0.75}]},
                {"led":1,"band":"r","components":[{"name":"white","median_relative":0.125}]}])")};
    EXPECT_EQ(averagedBudget(set({20_deg, 40_deg, 60_deg}, ""), captures, 1),
              R"([{"led":0,"band":"r","components":[{"name":"white","median_relative":0.5}]},)"
              R"({"led":1,"band":"r","components":[{"name":7,"median_relative":0.5}]},)"
              R"({"led":2,"band":"r","components":[{"name":"white","median_relative":0.125}]}])");
}

TEST(AverageOf, DustIsReportedAndWidensWhatItTouches) {
    std::vector<SampleSet> captures{capture(1), capture(2), capture(3)};
    CellSamples& dusty = captures[1].leds[0].bands[0];
    for (std::size_t cell = 5000; cell < 5030; ++cell) dusty.f[cell] *= 1.3;
    const Averaged average = averageOf(captures);
    ASSERT_EQ(average.outliers.size(), 30U);
    for (const Outlier& one : average.outliers) {
        EXPECT_EQ(one.capture, 1U);
        EXPECT_TRUE(one.cell >= 5000 && one.cell < 5030);
        const double truth = truthAt(CellGrid::centre(one.cell)) * (1 + kCommon);
        EXPECT_LE(std::abs(red(average.set).f[one.cell] - truth),
                  3 * red(average.set).uRandom[one.cell]);
    }
}

TEST(AverageOf, OneTwoAlikeAndAllMissingButOne) {
    const std::vector<SampleSet> one{capture(1)};
    const Averaged same = averageOf(one);
    EXPECT_EQ(red(same.set).uRandom[7], red(one[0]).uRandom[7]);
    EXPECT_EQ(red(same.set).f[7], red(one[0]).f[7]);
    EXPECT_EQ(same.cells.freedom, 0U);
    EXPECT_TRUE(std::isnan(same.cells.perFreedom()));
    EXPECT_EQ(same.cells.probability(), 1);

    std::vector<SampleSet> two{capture(1), capture(1)};
    const Averaged twins = averageOf(two);
    EXPECT_EQ(twins.cells.chiSquare, 0);
    EXPECT_EQ(red(twins.set).f[7], red(two[0]).f[7]);
    EXPECT_NEAR(red(twins.set).uRandom[7], red(two[0]).uRandom[7] / std::sqrt(2.0), 1e-15);

    // The second has a single cell, and a negative value there; the first lost it.
    const auto nothing = CellSamples::missing(CellGrid::count());
    const double f = -0.001;
    two[1].leds[0].bands[0] = nothing;
    two[1].leds[0].bands[0].f[7] = f;
    two[1].leds[0].bands[0].uRandom[7] = two[1].leds[0].bands[0].uSystematic[7] = 0.002;
    two[1].leds[0].bands[0].flags[7] = Flags{Flag::Measured, Flag::BelowNoise};
    two[0].leds[0].bands[0] = nothing;
    two[0].leds[0].bands[0].flags[7] = Flags{Flag::Saturated};
    const Averaged lone = averageOf(two);
    EXPECT_EQ(red(lone.set).f[7], f);
    EXPECT_EQ(red(lone.set).flags[7], (Flags{Flag::Measured, Flag::BelowNoise}));
    EXPECT_TRUE(std::isnan(red(lone.set).f[8]));
    EXPECT_FALSE(red(lone.set).present(8));
}

TEST(PlaneSymmetry, ComparesTheSidesOfThePlaneAndAveragesThem) {
    const Symmetrical good = planeSymmetrical(capture(4));  // truthAt knows x alone
    EXPECT_NEAR(good.consistency.perFreedom(), 1, chance(good.consistency));
    EXPECT_EQ(planeConsistency(capture(4)).chiSquare, good.consistency.chiSquare);
    const CellSamples before = red(capture(4));
    for (std::size_t cell = 3; cell < 15000; cell += 77) {
        const std::size_t image = mirroredCell(cell);
        ASSERT_EQ(mirroredCell(image), cell);
        EXPECT_NEAR(CellGrid::centre(cell).y(), -CellGrid::centre(image).y(), 1e-12);
        EXPECT_EQ(red(good.set).f[cell], red(good.set).f[image]);
        if (image == cell) {
            EXPECT_EQ(red(good.set).uRandom[cell], before.uRandom[cell]);
        } else {
            EXPECT_NEAR(red(good.set).uRandom[cell], before.uRandom[cell] / std::sqrt(2.0), 1e-4);
        }
    }
    SampleSet skew = capture(4);
    CellSamples& cells = skew.leds[0].bands[0];
    for (std::size_t i = 0; i < cells.size(); ++i) cells.f[i] *= 1 + 0.1 * CellGrid::centre(i).y();
    const Consistency found = planeConsistency(skew);
    EXPECT_GT(found.perFreedom(), 10);
    EXPECT_LT(found.probability(), 1e-9);
    EXPECT_NEAR(found.medianRelative, 0.06, 0.03);
}

TEST(ReciprocalAverage, BringsPairsOfAnyTwoRotationsTogether) {
    // Reciprocal, and of a surface that knows its own x axis.
    const auto brushed = [](const LightView& pair) {
        return 1 + 0.3 * pair.in.vector().dot(pair.out.vector()) + pair.in.x() * pair.out.x();
    };
    SampleSet set;
    for (const double rotation : {0.0, 70.0}) {
        for (const Radians incidence : {0_deg, 20_deg, 60_deg}) {
            LedTable led{.incidence = incidence, .rotation = rotationOf(rotation), .bands = {}};
            led.bands = test::ledTable(incidence, [&](Radians, const Direction& wo) {
                            return brushed(pairInSample(led, wo));
                        }).bands;
            set.leds.push_back(std::move(led));
        }
    }
    const Reciprocal good = reciprocalAverage(set);
    // 2 x 2 rotations of each of three pairs of LEDs, and each LED with itself turned.
    EXPECT_EQ(good.pairs, 3U * (12U + 3U));
    EXPECT_LT(good.consistency.perFreedom(), 0.01);  // bilinear alone
    for (CellSamples& cells : set.leds[2].bands) {
        for (double& f : cells.f) f *= 1.2;
    }
    const Reciprocal bad = reciprocalAverage(set);
    EXPECT_GT(bad.consistency.perFreedom(), 4);
    const std::size_t cell = *CellGrid::cellAt(Direction::fromSpherical(20_deg, Radians(0)));
    EXPECT_TRUE(bad.set.leds[2].bands[0].flags[cell].has(Flag::Reciprocity));
    EXPECT_LT(bad.set.leds[2].bands[0].f[cell], set.leds[2].bands[0].f[cell]);
}

/// A cell that has several partners moves to the mean of all, not by each of them in turn.
TEST(ReciprocalAverage, MovesACellOnceHoweverManyPartnersItHas) {
    const auto flat = [](double f) {
        return test::ledTable(20_deg, [f](Radians, const Direction&) { return f; });
    };
    SampleSet set;
    set.leds = {flat(1.09), flat(1), flat(1), flat(1)};
    for (std::size_t i = 1; i < 4; ++i) {
        set.leds[i].incidence = Radians();
        set.leds[i].rotation = rotationOf(30.0 * static_cast<double>(i));
    }
    const SampleSet averaged = reciprocalAverage(set).set;
    const std::size_t normal = *CellGrid::cellAt(Direction::fromSpherical(0_deg, Radians()));
    // u_apart is 2.24 % of f: weights 1 / 1.09^2, 1, 1, 1.
    EXPECT_NEAR(red(averaged).f[normal], (1 / 1.09 + 3) / (1 / (1.09 * 1.09) + 3), 1e-9);
    EXPECT_NEAR(red(averaged).uRandom[normal], 0.01 / std::sqrt(1 / (1.09 * 1.09) + 3), 1e-9);
}

}  // namespace
}  // namespace gonio::proc
