#include "proc/plan/planner.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "proc/core/number_text.h"
#include "proc/core/parallel.h"
#include "proc/plan/cover_bound.h"
#include "proc/plan/prediction.h"
#include "proc/plan/shared_choice.h"

namespace gonio::proc {
namespace {

constexpr double kAnything = 1e6;      // a relative uncertainty that no cell needs a frame for
constexpr double kStrictest = 1e-5;    // where a budget's search ends
constexpr double kBudgetStep = 1.002;  // and how finely

Seconds seconds(Nanoseconds time) { return Seconds(time); }

class Planner {
public:
    Planner(const PlanInput& input, const PlanGoal& goal)
        : input_(input),
          goal_(goal),
          cost_(input.rig.timing),
          means_(Means::of(shotOptions(input.rig, mostDarkFrames(input.rig)), input.rig.maxFrames)),
          pilots_(input.rig.pilotShots()) {}

    Plan forWanted(double wanted) const {
        const std::vector<StateDemands> demands = demandsFor(wanted);
        const SharedChoice choice = choiceFor(demands);
        Plan plan{.goal = goal_, .wanted = wanted, .pilots = pilots_};
        plan.darkFrames = choice.darkFrames;
        plan.proven = choice.proven;
        for (const Seconds exposure : choice.darks)
            plan.darks.push_back({.exposure = exposure, .frames = choice.darkFrames});
        for (std::size_t s = 0; s < demands.size(); ++s)
            plan.states.push_back(statePlan(choice, s));
        plan.seconds = timeOf(plan);
        plan.predicted = prediction(choice, wanted);
        for (std::size_t s = 0; s < demands.size(); ++s) {
            plan.counts = plan.counts + demands[s].counts;
            for (UnreachedCell cell : demands[s].unreached) {
                cell.state = s;
                plan.unreached.push_back(cell);
            }
            plan.cramerRao += Seconds(idealSeconds(demands[s].needs));
        }
        plan.notes = notesOf(plan);
        return plan;
    }

    /// The smallest uncertainty, within kBudgetStep, whose plan fits.
    Result<Plan> forBudget(Seconds budget) const {
        Plan best = forWanted(kAnything);
        if (best.seconds.total() > budget) {
            return Error{.kind = ErrorKind::Usage,
                         .message = "plan: a budget of " + fixed(budget.count(), 3) +
                                    " s is too short: pilots and dark frames of " +
                                    std::to_string(input_.states.size()) + " states take " +
                                    fixed(best.seconds.total().count(), 3) + " s at least"};
        }
        double fits = kAnything;
        double exceeds = kStrictest;
        while (fits / exceeds > kBudgetStep) {
            const double middle = std::sqrt(fits * exceeds);
            Plan plan = forWanted(middle);
            if (plan.seconds.total() <= budget) {
                fits = middle;
                best = std::move(plan);
            } else {
                exceeds = middle;
            }
        }
        best.wanted = fits;
        return best;
    }

private:
    static int mostDarkFrames(const RigModel& rig) {
        return rig.darkFramesHeld > 0
                   ? rig.darkFramesHeld
                   : *std::max_element(std::begin(kDarkChoices), std::end(kDarkChoices));
    }

    [[nodiscard]] CellDemand demand(const PlanCell& cell, double wanted) const {
        return demandOf(cell, goal_, wanted, input_.floor, means_.brightest);
    }

    [[nodiscard]] std::vector<StateDemands> demandsFor(double wanted) const {
        std::vector<StateDemands> demands(input_.states.size());
        parallelFor(demands.size(), [&](IndexRange range) {
            for (std::size_t s = range.begin; s < range.end; ++s) {
                demands[s] = demandsOf(
                    input_.states[s],
                    [&](const PlanCell& cell) { return demand(cell, wanted); },
                    means_);
                demands[s].needs = essentialNeeds(shotsOf(), binnedNeeds(demands[s].needs, means_));
            }
        });
        return demands;
    }

    /// Of all options, with nothing taken yet.
    [[nodiscard]] std::vector<CoverShot> shotsOf() const {
        std::vector<CoverShot> shots;
        for (const ShotOption& option : means_.options)
            shots.push_back({.option = option,
                             .frame = cost_.frame(option.kind.exposure),
                             .lastFrame = cost_.lastFrame(option.kind.exposure)});
        return shots;
    }

    /// What is asked never exceeds what a single shot of maxFrames tells: there always is one.
    [[nodiscard]] SharedChoice choiceFor(const std::vector<StateDemands>& demands) const {
        std::vector<std::vector<CoverNeed>> needs;
        for (const StateDemands& state : demands) needs.push_back(state.needs);
        return cheapestChoice(
                   {.rig = input_.rig, .pilotsAreData = goal_.pilotsAreData, .needs = needs})
            .value();
    }

    [[nodiscard]] double idealSeconds(const std::vector<CoverNeed>& needs) const {
        return coverBound({.shots = shotsOf(), .needs = needs}).seconds;
    }

    [[nodiscard]] StatePlan statePlan(const SharedChoice& choice, std::size_t s) const {
        StatePlan plan{.led = input_.states[s].led, .band = input_.states[s].band};
        std::vector<std::size_t> order(choice.options.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return choice.options[a].reach > choice.options[b].reach;
        });
        for (const std::size_t g : order) {
            if (choice.more[s][g] == 0) continue;
            plan.captures.push_back({.shot = choice.options[g].kind, .frames = choice.more[s][g]});
        }
        return plan;
    }

    [[nodiscard]] TimeParts timeOf(const Plan& plan) const {
        const RigTiming& timing = input_.rig.timing;
        TimeParts parts;
        parts.settle = timing.ledSettle;  // the first LED
        parts.latency = timing.handover + seconds(waitForPlan(input_.rig, plan.darkFrames));
        parts.readout = timing.transfer;  // of the last picture
        for (const ShotKind& shot : plan.pilots)
            parts.pilot +=
                seconds(cost_.lastFrame(shot.exposure)) *
                static_cast<double>(plan.states.size() + 1);  // those of the first state twice
        for (const DarkCapture& dark : plan.darks)
            parts.dark += seconds(cost_.darkCapture(dark.exposure, dark.frames));
        for (const StatePlan& state : plan.states) {
            for (const PlannedCapture& capture : state.captures) addTo(parts, capture);
        }
        return parts;
    }

    /// What the last frame takes beyond its place in the stream is the LED's settling first.
    void addTo(TimeParts& parts, const PlannedCapture& capture) const {
        const Seconds exposure = capture.shot.exposure;
        const Seconds light = exposure * capture.frames;
        const Seconds whole = seconds(cost_.capture(exposure, capture.frames));
        const Seconds stream = seconds(capture.frames * cost_.frame(exposure));
        const Seconds beyond = whole - stream;
        const Seconds settle = std::min(beyond, input_.rig.timing.ledSettle);
        parts.exposure += light;
        parts.readout += stream - light;
        parts.settle += settle;
        parts.latency += beyond - settle;
    }

    [[nodiscard]] Prediction prediction(const SharedChoice& choice, double wanted) const {
        PredictionSum sum(input_.floor);
        for (std::size_t s = 0; s < input_.states.size(); ++s) {
            StateFrames taken{.options = choice.options, .frames = choice.more[s]};
            for (std::size_t g = 0; g < taken.frames.size(); ++g) taken.frames[g] += choice.have[g];
            for (const PlanCell& cell : input_.states[s].cells) {
                if (demand(cell, wanted).kind == CellDemand::Kind::Planned) sum.add(cell, taken);
            }
        }
        return sum.result();
    }

    [[nodiscard]] std::vector<std::string> notesOf(const Plan& plan) const {
        std::vector<std::string> notes;
        const auto note = [&](std::size_t cells, const std::string& what) {
            if (cells > 0) notes.push_back(std::to_string(cells) + " cells " + what);
        };
        note(plan.counts.heldAtTheFloor,
             "are held above the wanted " + perCent(plan.wanted) + ", at " +
                 fixed(goal_.floorShare, 2) + " of their systematic uncertainty: more frames " +
                 "would hardly improve their total");
        note(plan.counts.saturated, "saturate the shortest exposure at the dimmest level");
        note(plan.counts.tooDim,
             "are too dim for " + std::to_string(input_.rig.maxFrames) +
                 " frames of any shot to reach the goal");
        note(plan.counts.noSignal, "have no light of their own");
        if (!plan.proven) notes.emplace_back("the plan is good, but not proven to be the cheapest");
        note(plan.counts.ignored, "without a pilot value are left out");
        return notes;
    }

    const PlanInput& input_;
    const PlanGoal& goal_;
    ShotCost cost_;
    Means means_;
    std::vector<ShotKind> pilots_;
};

}  // namespace

int Plan::framesOf(std::size_t state) const {
    int sum = 0;
    for (const PlannedCapture& capture : states[state].captures) sum += capture.frames;
    return sum;
}

Result<Plan> planCaptures(const PlanInput& input, const PlanGoal& goal) {
    if (Result<void> good = input.rig.check(); !good) return good.error();
    if (Result<void> good = goal.check(); !good) return good.error();
    if (input.states.empty())
        return Error{.kind = ErrorKind::Usage, .message = "plan: there is no state to plan for"};
    const Planner planner(input, goal);
    if (goal.budget) return planner.forBudget(*goal.budget);
    return planner.forWanted(*goal.wanted);
}

}  // namespace gonio::proc
