#include "daemon/light_watch.h"

#include <algorithm>
#include <cmath>

#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

std::string described(const LightStep& step) {
    const proc::LightChange& change = step.change;
    const bool one = change.first == change.last;
    const std::string which = one ? "frame " + std::to_string(change.first + 1) + " of " +
                                        std::to_string(step.frames) + " is "
                                  : "frames " + std::to_string(change.first + 1) + " to " +
                                        std::to_string(change.last + 1) + " of " +
                                        std::to_string(step.frames) + " are ";
    return stateName(step.state) + ": " + which + fixed(100 * std::abs(change.offset.size), 1) +
           " % (u " + fixed(100 * change.offset.u, 1) + " %) " +
           (change.offset.size < 0 ? "darker" : "brighter") + " than the others";
}

}  // namespace

std::optional<LightStep> lightStep(State state,
                                   const proc::BracketSums& sums,
                                   const proc::MergedState& merged,
                                   double smallest) {
    const proc::FrameReport report = proc::frameResiduals(sums, merged, smallest);
    if (!report.change) return std::nullopt;
    return LightStep{.state = state, .change = *report.change, .frames = report.frames.size()};
}

std::string described(std::span<const LightStep> steps) {
    std::string text;
    for (const LightStep& step : steps) text += (text.empty() ? "" : "; ") + described(step);
    return text;
}

proc::Verdict lightVerdict(std::span<const LightStep> steps, double smallest) {
    proc::Verdict verdict{.name = "light",
                          .grade = proc::Grade::Ok,
                          .figure = {},
                          .evidence = "steady within each bracket",
                          .next = {}};
    if (steps.empty()) return verdict;
    const auto sizeOf = [](const LightStep& step) { return std::abs(step.change.offset.size); };
    const LightStep& largest = *std::ranges::max_element(steps, {}, sizeOf);
    verdict.grade = proc::Grade::Refused;
    verdict.figure = proc::Figure{
        .value = sizeOf(largest), .u = largest.change.offset.u, .unit = "1", .limit = smallest};
    verdict.evidence = "the light changed: " + described(steps);
    verdict.next = "measure again";
    return verdict;
}

}  // namespace gonio::daemon
