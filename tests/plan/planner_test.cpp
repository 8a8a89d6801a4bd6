// Plans and their laws: monotone, honest about what cannot be reached, within a budget.

#include "proc/plan/planner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "proc/core/number_text.h"
#include "proc/plan/progress.h"
#include "tests/plan/small_rig.h"

namespace {

using namespace gonio;
using namespace gonio::proc;
using test::SmallScene;
using test::smallScene;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

PlanGoal wanted(double relative) { return {.wanted = relative}; }

TEST(Planner, StricterGoalNeverGetsACheaperPlan) {
    for (int levels : {1, 2, 3}) {
        const SmallScene scene = smallScene(3, levels);
        Seconds before{0};
        for (double w = 0.3; w > 0.007; w /= 1.5) {
            const Result<Plan> plan = planCaptures(scene.input(), wanted(w));
            ASSERT_TRUE(plan);
            ASSERT_TRUE(plan->proven);
            EXPECT_GE(plan->seconds.total(), before - Seconds(1e-9)) << levels << " " << w;
            before = plan->seconds.total();
        }
    }
}

TEST(Planner, PlannedCellsReachWhatIsWanted) {
    const SmallScene scene = smallScene();
    for (double w : {0.1, 0.01, 0.006}) {
        const Result<Plan> plan = planCaptures(scene.input(), wanted(w));
        ASSERT_TRUE(plan);
        EXPECT_LE(plan->predicted.random.worst, w * (1 + 1e-9));
        EXPECT_GE(plan->predicted.random.worst, plan->predicted.cramerRao.worst);
        EXPECT_GE(plan->seconds.total(), plan->cramerRao);
        EXPECT_EQ(plan->predicted.cells, plan->counts.planned);
        EXPECT_TRUE(plan->unreached.empty());
    }
}

TEST(Planner, PilotFramesAreData) {
    const SmallScene scene = smallScene();
    PlanGoal apart = wanted(0.01);
    apart.pilotsAreData = false;
    const Result<Plan> with = planCaptures(scene.input(), wanted(0.01));
    const Result<Plan> without = planCaptures(scene.input(), apart);
    ASSERT_TRUE(with && without);
    EXPECT_LT(with->seconds.total(), without->seconds.total());
    EXPECT_LT(with->framesOf(0), without->framesOf(0));
}

TEST(Planner, StopRuleHoldsRandomAtAShareOfTheFloorAndSaysSo) {
    const SmallScene scene = smallScene();
    PlanGoal beyond = wanted(0.002);
    beyond.beyondFloor = true;
    const Result<Plan> held = planCaptures(scene.input(), wanted(0.002));
    const Result<Plan> unheld = planCaptures(scene.input(), beyond);
    ASSERT_TRUE(held && unheld);
    EXPECT_GT(held->counts.heldAtTheFloor, 0U);
    ASSERT_FALSE(held->notes.empty());
    EXPECT_NE(held->notes.front().find("systematic"), std::string::npos);
    EXPECT_EQ(unheld->counts.heldAtTheFloor, 0U);
    EXPECT_LT(held->seconds.total(), unheld->seconds.total());
    EXPECT_LE(unheld->predicted.random.worst, 0.002 * (1 + 1e-9));
    // sqrt(1 + 1/9) of the floor.
    EXPECT_LE(held->predicted.total.worst, held->predicted.systematic.worst * 1.0542);
}

TEST(Planner, BudgetIsKeptAndUsed) {
    const SmallScene scene = smallScene();
    const Result<Plan> plan = planCaptures(scene.input(), PlanGoal::within(Seconds(0.9)));
    ASSERT_TRUE(plan);
    EXPECT_LE(plan->seconds.total(), Seconds(0.9));
    const Result<Plan> stricter = planCaptures(scene.input(), wanted(plan->wanted / 1.01));
    ASSERT_TRUE(stricter);
    EXPECT_GT(stricter->seconds.total(), Seconds(0.9));
}

TEST(Planner, ImpossibleBudgetIsAUsageErrorThatSaysTheLeastTime) {
    const SmallScene scene = smallScene();
    const Result<Plan> plan = planCaptures(scene.input(), PlanGoal::within(Seconds(0.05)));
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().kind, ErrorKind::Usage);
    const Result<Plan> nothing = planCaptures(scene.input(), wanted(1e6));
    ASSERT_TRUE(nothing);
    EXPECT_NE(plan.error().message.find(fixed(nothing->seconds.total().count(), 3)),
              std::string::npos)
        << plan.error().message;
}

TEST(Planner, RefusesGoalsAndRigsOutOfTheirDomain) {
    SmallScene scene = smallScene();
    for (const PlanGoal& goal : {PlanGoal{},
                                 PlanGoal{.wanted = 0.1, .budget = Seconds(3)},
                                 wanted(0),
                                 wanted(kNan),
                                 PlanGoal{.wanted = 0.1, .fMin = 0}}) {
        const Result<Plan> plan = planCaptures(scene.input(), goal);
        ASSERT_FALSE(plan);
        EXPECT_EQ(plan.error().kind, ErrorKind::Usage);
    }
    scene.rig.levels = {0.05, 1};
    EXPECT_FALSE(planCaptures(scene.input(), wanted(0.1)));
    scene.rig.levels = {1};
    scene.states.clear();
    EXPECT_FALSE(planCaptures(scene.input(), wanted(0.1)));
}

TEST(Planner, ZeroSignalTakesPilotsAndDarksAlone) {
    SmallScene scene = smallScene();
    scene.states.front().cells = {{.f = 0, .rate = 0, .pixels = 44}};
    const Result<Plan> plan = planCaptures(scene.input(), wanted(0.01));
    ASSERT_TRUE(plan);
    EXPECT_EQ(plan->framesOf(0), 0);
    EXPECT_EQ(plan->counts.belowRange, 1U);
    EXPECT_EQ(plan->predicted.cells, 0U);
    EXPECT_TRUE(std::isnan(plan->predicted.random.worst));
}

TEST(Planner, NoLightOfItsOwnIsNamed) {
    SmallScene scene = smallScene();
    scene.states.front().cells = {{.f = 0.1, .rate = 5, .pixels = 44, .background = 5}};
    const Result<Plan> plan = planCaptures(scene.input(), wanted(0.01));
    ASSERT_TRUE(plan);
    EXPECT_EQ(plan->counts.noSignal, 1U);
    ASSERT_EQ(plan->unreached.size(), 1U);
    EXPECT_EQ(plan->unreached.front().why, Shortcoming::NoSignal);
}

TEST(Planner, AllSaturatedIsCountedAndNamed) {
    SmallScene scene = smallScene();
    for (PlanCell& cell : scene.states.front().cells) cell.rate = 1e15;
    scene.states.front().cells.front().rate = std::numeric_limits<double>::infinity();
    const Result<Plan> plan = planCaptures(scene.input(), wanted(0.01));
    ASSERT_TRUE(plan);
    EXPECT_EQ(plan->framesOf(0), 0);
    EXPECT_EQ(plan->counts.saturated, scene.states.front().cells.size());
    EXPECT_EQ(plan->unreached.size(), scene.states.front().cells.size());
    EXPECT_EQ(plan->unreached.back().why, Shortcoming::Saturated);
}

TEST(Planner, NanPilotsAreIgnoredAndCounted) {
    SmallScene scene = smallScene();
    const Result<Plan> clean = planCaptures(scene.input(), wanted(0.01));
    auto& cells = scene.states.front().cells;
    cells.push_back({.f = kNan, .rate = 1e6, .pixels = 44});
    cells.push_back({.f = 0.1, .rate = kNan, .pixels = 44});
    cells.push_back({.f = 0.1, .rate = 1e6, .pixels = 0});
    const Result<Plan> plan = planCaptures(scene.input(), wanted(0.01));
    ASSERT_TRUE(clean && plan);
    EXPECT_EQ(plan->counts.ignored, 3U);
    EXPECT_EQ(plan->seconds.total(), clean->seconds.total());
}

TEST(Planner, OneElectronPerPixelIsReachedByManyFramesOrNamed) {
    SmallScene scene = smallScene();
    // One electron in the longest exposure at full level.
    scene.states.front().cells = {{.f = 0.01, .rate = 1 / 0.04, .pixels = 44}};
    const Result<Plan> coarse = planCaptures(scene.input(), wanted(0.1));
    ASSERT_TRUE(coarse);
    EXPECT_LE(coarse->predicted.random.worst, 0.1);
    EXPECT_GT(coarse->framesOf(0), 10);
    EXPECT_TRUE(coarse->unreached.empty());
    const Result<Plan> fine = planCaptures(scene.input(), wanted(0.005));
    ASSERT_TRUE(fine);
    EXPECT_EQ(fine->counts.tooDim, 1U);
    EXPECT_EQ(fine->unreached.front().why, Shortcoming::TooDim);
    EXPECT_LE(fine->framesOf(0), scene.rig.maxFrames);
}

TEST(Planner, OneExposureAndOneLevelAreEnoughForANarrowRange) {
    SmallScene scene = smallScene();
    scene.rig.levels = {1};
    scene.rig.exposures = {Seconds(320e-6)};
    scene.states.front().cells = {{.f = 0.3, .rate = 1e7, .pixels = 44}};
    const Result<Plan> plan = planCaptures(scene.input(), wanted(0.003));
    ASSERT_TRUE(plan);
    EXPECT_EQ(plan->pilots.size(), 1U);
    EXPECT_LE(plan->predicted.random.worst, 0.003);
}

TEST(Planner, HotSensorIsPlannedWithItsDarkCurrent) {
    SmallScene scene = smallScene();
    const Result<Plan> cool = planCaptures(scene.input(), wanted(0.02));
    scene.rig.sensor.celsius = 80;
    const Result<Plan> hot = planCaptures(scene.input(), wanted(0.02));
    ASSERT_TRUE(cool && hot);
    EXPECT_GE(hot->seconds.total(), cool->seconds.total());
    EXPECT_GT(hot->predicted.random.worst, 0);
}

TEST(Planner, PartsOfTheTimeAddUpToItsCaptures) {
    const SmallScene scene = smallScene();
    const Result<Plan> plan = planCaptures(scene.input(), wanted(0.01));
    ASSERT_TRUE(plan);
    const ShotCost cost(scene.rig.timing);
    Nanoseconds sum{0};
    for (const ShotKind& shot : plan->pilots) sum += 2 * cost.lastFrame(shot.exposure);
    for (const DarkCapture& dark : plan->darks) sum += cost.darkCapture(dark.exposure, dark.frames);
    for (const PlannedCapture& c : plan->states[0].captures)
        sum += cost.capture(c.shot.exposure, c.frames);
    const RigTiming& timing = scene.rig.timing;
    const Seconds ends = timing.ledSettle + timing.handover + timing.transfer;
    const double rest = (plan->seconds.total() - Seconds(sum) - ends).count();
    EXPECT_GE(rest, -1e-9);
    EXPECT_LE(rest, (timing.planning + timing.transfer).count());
}

TEST(Progress, RunsFromNothingToThePlan) {
    const SmallScene scene = smallScene();
    const PlanInput input = scene.input();
    const Result<Plan> plan = planCaptures(input, wanted(0.01));
    ASSERT_TRUE(plan);
    const Progress none = progressOf(input, *plan, {});
    EXPECT_EQ(none.remaining, plan->seconds.total());
    EXPECT_TRUE(std::isinf(none.achieved.random.worst));
    Seconds before = none.remaining;
    CapturesTaken taken{.pilots = plan->pilots.size(), .darks = plan->darks.size()};
    for (; taken.captures <= plan->states[0].captures.size(); ++taken.captures) {
        const Progress now = progressOf(input, *plan, taken);
        EXPECT_LT(now.remaining, before);
        before = now.remaining;
    }
    const Progress done = progressOf(input, *plan, {99, 99, 99});
    EXPECT_EQ(done.remaining, Seconds(0));
    EXPECT_DOUBLE_EQ(done.share, 1);
    EXPECT_DOUBLE_EQ(done.achieved.random.worst, plan->predicted.random.worst);
    EXPECT_DOUBLE_EQ(done.achieved.total.median, plan->predicted.total.median);
}

}  // namespace
