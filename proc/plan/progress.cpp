#include "proc/plan/progress.h"

#include <algorithm>
#include <limits>

#include "proc/plan/prediction.h"
#include "proc/plan/shared_choice.h"

namespace gonio::proc {
namespace {

/// How many of `all` alike things of each state the first `taken` cover, state by state.
int ofState(std::size_t state, std::size_t perState, std::size_t taken) {
    const std::size_t before = state * perState;
    return static_cast<int>(taken <= before ? 0 : std::min(perState, taken - before));
}

class Tally {
public:
    Tally(const PlanInput& input, const Plan& plan)
        : input_(input),
          plan_(plan),
          cost_(input.rig.timing),
          options_(shotOptions(input.rig, plan.darkFrames)) {}

    /// What these took, without what comes before the first and after the last.
    [[nodiscard]] Nanoseconds spent(const CapturesTaken& taken) const {
        Nanoseconds sum{0};
        const std::size_t kinds = plan_.pilots.size();
        const std::size_t pilots = std::min(taken.pilots, kinds * plan_.states.size());
        for (std::size_t i = 0; i < pilots; ++i)
            sum += cost_.lastFrame(plan_.pilots[i % kinds].exposure);
        for (std::size_t i = 0; i < std::min(taken.darks, plan_.darks.size()); ++i)
            sum += cost_.darkCapture(plan_.darks[i].exposure, plan_.darks[i].frames);
        std::size_t left = taken.captures;
        for (const StatePlan& state : plan_.states) {
            for (const PlannedCapture& capture : state.captures) {
                if (left == 0) return sum;
                --left;
                sum += cost_.capture(capture.shot.exposure, capture.frames);
            }
        }
        return sum;
    }

    [[nodiscard]] Prediction achieved(const CapturesTaken& taken) const {
        PredictionSum sum(input_.floor);
        std::size_t cells = 0;
        for (const StatePilot& state : input_.states) cells += state.cells.size();
        sum.reserve(cells);
        const double brightest = Means::of(options_, input_.rig.maxFrames).brightest;
        std::size_t left = taken.captures;
        for (std::size_t s = 0; s < plan_.states.size(); ++s) {
            const StateFrames frames{.options = options_, .frames = framesOf(s, taken, left)};
            for (const PlanCell& cell : input_.states[s].cells) {
                const CellDemand asked =
                    demandOf(cell, plan_.goal, plan_.wanted, input_.floor, brightest);
                if (asked.kind == CellDemand::Kind::Planned) sum.add(cell, frames);
            }
            left -= std::min(left, plan_.states[s].captures.size());
        }
        return sum.result();
    }

private:
    /// Of each option, what the state has; `left` captures are its own or of later states.
    [[nodiscard]] std::vector<int> framesOf(std::size_t state,
                                            const CapturesTaken& taken,
                                            std::size_t left) const {
        std::vector<int> frames(options_.size(), 0);
        const auto add = [&](const ShotKind& kind, int count) {
            for (std::size_t g = 0; g < options_.size(); ++g) {
                if (options_[g].kind == kind) frames[g] += count;
            }
        };
        if (plan_.goal.pilotsAreData) {
            const int pilots = ofState(state, plan_.pilots.size(), taken.pilots);
            for (int i = 0; i < pilots; ++i) add(plan_.pilots[static_cast<std::size_t>(i)], 1);
        }
        const std::vector<PlannedCapture>& captures = plan_.states[state].captures;
        for (std::size_t i = 0; i < std::min(left, captures.size()); ++i)
            add(captures[i].shot, captures[i].frames);
        return frames;
    }

    const PlanInput& input_;
    const Plan& plan_;
    ShotCost cost_;
    std::vector<ShotOption> options_;
};

}  // namespace

Progress progressOf(const PlanInput& input, const Plan& plan, const CapturesTaken& taken) {
    const Tally tally(input, plan);
    const std::size_t most = std::numeric_limits<std::size_t>::max();
    const Seconds all(tally.spent({.pilots = most, .darks = most, .captures = most}));
    const Seconds spent(tally.spent(taken));
    const Seconds total = plan.seconds.total();
    Progress progress;
    progress.remaining = spent >= all ? Seconds(0) : total - spent;
    progress.spent = total - progress.remaining;
    progress.share = progress.spent / total;
    progress.achieved = tally.achieved(taken);
    return progress;
}

}  // namespace gonio::proc
