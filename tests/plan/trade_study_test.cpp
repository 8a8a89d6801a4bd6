// The goals of the trade of acquisition on the worst material, all overheads counted, and the laws
// of its rows.

#include "proc/plan/trade_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "proc/plan/prediction.h"
#include "proc/plan/shared_choice.h"

namespace {

using namespace gonio;
using namespace gonio::proc;

/// Gloss metal with three levels.
struct Worst {
    explicit Worst(const RigTiming& timing)
        : rig(tradeRig(timing, levelChoice(3).levels)),
          states(tradeStates(tradeMaterials().back(), levelChoice(3).budget)) {}
    RigModel rig;
    std::vector<StatePilot> states;
    SystematicFloor floor = SystematicFloor::typical(Zero::ZeroReference);

    [[nodiscard]] Plan plan(const PlanGoal& goal) const {
        return planCaptures({rig, states, floor}, goal).value();
    }
    /// Worst total uncertainty, k = 1, of the cells with at least this f.
    [[nodiscard]] double total(const Plan& made, double fMin) const {
        const std::vector<ShotOption> options = shotOptions(rig, made.darkFrames);
        double worst = 0;
        for (std::size_t s = 0; s < states.size(); ++s) {
            StateFrames taken{.options = options, .frames = std::vector<int>(options.size(), 0)};
            for (std::size_t g = 0; g < options.size(); ++g) {
                for (const ShotKind& pilot : made.pilots)
                    taken.frames[g] += options[g].kind == pilot;
                for (const PlannedCapture& c : made.states[s].captures)
                    taken.frames[g] += options[g].kind == c.shot ? c.frames : 0;
            }
            for (const PlanCell& cell : states[s].cells) {
                if (cell.f < fMin) continue;
                worst = std::max(
                    worst, std::hypot(randomUncertainty(cell, taken), floor.at(cell.f) / cell.f));
            }
        }
        return worst;
    }
};

TEST(TradeGoals, OfTheUsb2RigOnGlossMetal) {
    const Worst worst(RigTiming::usb2());
    const Plan draft = worst.plan(PlanGoal::of(Effort::Draft));
    EXPECT_LE(draft.seconds.total(), Seconds(3.0));
    EXPECT_LE(draft.predicted.random.worst, 0.10);
    const Plan standard = worst.plan(PlanGoal::of(Effort::Standard));
    EXPECT_LE(standard.seconds.total(), Seconds(3.6));
    EXPECT_LE(standard.predicted.random.worst, 0.01);
    const Plan reference = worst.plan(PlanGoal::of(Effort::Reference));
    EXPECT_LE(reference.seconds.total(), Seconds(9));
    EXPECT_LE(reference.predicted.random.worst, promisedUncertainty(Effort::Reference));
    EXPECT_LE(2 * worst.total(reference, 0.01), 0.016);
}

TEST(TradeGoals, OfTheUsb3RigOnGlossMetal) {
    const Worst worst(RigTiming::usb3());
    const Plan draft = worst.plan(PlanGoal::of(Effort::Draft));
    EXPECT_LE(draft.seconds.total(), Seconds(1.5));
    EXPECT_LE(draft.predicted.random.worst, 0.10);
    const Plan standard = worst.plan(PlanGoal::of(Effort::Standard));
    EXPECT_LE(standard.seconds.total(), Seconds(1.8));
    EXPECT_LE(standard.predicted.random.worst, 0.01);
    const Plan reference = worst.plan(PlanGoal::of(Effort::Reference));
    EXPECT_LE(reference.seconds.total(), Seconds(5.5));
    EXPECT_LE(reference.predicted.random.worst, promisedUncertainty(Effort::Reference));
    EXPECT_LE(2 * worst.total(reference, 0.01), 0.016);
}

TEST(TradeStudy, RowsComeInOrderAndFewerLevelsTakeLonger) {
    TradeSweep sweep = TradeSweep::quick();
    sweep.rigs.resize(1);
    sweep.levels = {2, 3};
    sweep.materials = {tradeMaterials().back()};
    sweep.wanted = {0.10, 0.03};
    const auto rows = tradeAcquisition(sweep);
    ASSERT_TRUE(rows);
    ASSERT_EQ(rows->size(), 4U);
    for (std::size_t i = 0; i + 1 < rows->size(); i += 2)
        EXPECT_LE((*rows)[i].seconds.total(), (*rows)[i + 1].seconds.total());
    EXPECT_GT((*rows)[1].seconds.total(), (*rows)[3].seconds.total());
    for (const TradeRow& row : *rows) EXPECT_LT(row.cramerRao, row.seconds.total());
    const std::string csv = tradeCsv(*rows);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
    const std::string table = tradeMarkdown(*rows);
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 6);
}

}  // namespace
