#include "proc/plan/shared_choice.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "proc/core/parallel.h"
#include "proc/plan/cover_bound.h"

namespace gonio::proc {
namespace {

bool contains(const std::vector<Seconds>& list, Seconds exposure) {
    return std::find(list.begin(), list.end(), exposure) != list.end();
}

/// One set of exposures with one number of dark frames.
struct Candidate {
    int darkFrames = 1;
    std::vector<Seconds> exposures;  ///< the pilots' first
    Nanoseconds darkCost{0};         ///< waiting for the plan included
    Nanoseconds least{0};            ///< of the run, by the bounds of the states
};

class Chooser {
public:
    explicit Chooser(const SharedProblem& problem)
        : problem_(problem), cost_(problem.rig.timing), pilots_(pilotExposures(problem.rig)) {
        for (const Seconds exposure : problem.rig.exposures) {
            if (!contains(pilots_, exposure)) others_.push_back(exposure);
        }
    }

    std::optional<SharedChoice> best() {
        std::vector<Candidate> candidates = all();
        for (Candidate& candidate : candidates) candidate.least = bound(candidate);
        std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
            return a.least < b.least;
        });
        std::optional<SharedChoice> best;
        for (const Candidate& candidate : candidates) {
            const Nanoseconds limit = best ? best->cost : Nanoseconds::max();
            if (candidate.least >= limit) break;
            if (std::optional<SharedChoice> better = solve(candidate, limit))
                best = std::move(better);
        }
        return best;
    }

private:
    [[nodiscard]] std::vector<Candidate> all() const {
        std::vector<Candidate> candidates;
        const int held = problem_.rig.darkFramesHeld;
        if (held > 0) {
            candidates.push_back(candidate(held, (std::size_t{1} << others_.size()) - 1));
            return candidates;
        }
        for (const int frames : kDarkChoices) {
            for (std::size_t set = 0; set < std::size_t{1} << others_.size(); ++set)
                candidates.push_back(candidate(frames, set));
        }
        return candidates;
    }

    [[nodiscard]] Candidate candidate(int frames, std::size_t set) const {
        Candidate made{.darkFrames = frames, .exposures = pilots_};
        for (std::size_t i = 0; i < others_.size(); ++i) {
            if ((set >> i & 1U) != 0) made.exposures.push_back(others_[i]);
        }
        made.darkCost = waitForPlan(problem_.rig, frames);
        if (problem_.rig.darkFramesHeld > 0) return made;
        for (const Seconds exposure : made.exposures)
            made.darkCost += cost_.darkCapture(exposure, frames);
        return made;
    }

    [[nodiscard]] CoverProblem coverOf(const Candidate& candidate, std::size_t state) const {
        CoverProblem cover{
            .shots = {}, .needs = problem_.needs[state], .maxFrames = problem_.rig.maxFrames};
        const std::vector<ShotKind> pilots = problem_.rig.pilotShots();
        for (const ShotOption& option : shotOptions(problem_.rig, candidate.darkFrames)) {
            if (!contains(candidate.exposures, option.kind.exposure)) continue;
            const bool piloted =
                problem_.pilotsAreData &&
                std::find(pilots.begin(), pilots.end(), option.kind) != pilots.end();
            cover.shots.push_back({.option = option,
                                   .have = piloted ? 1 : 0,
                                   .frame = cost_.frame(option.kind.exposure),
                                   .lastFrame = cost_.lastFrame(option.kind.exposure)});
        }
        return cover;
    }

    /// What each state costs at least.
    [[nodiscard]] std::vector<double> bounds(const Candidate& candidate) const {
        std::vector<double> seconds(problem_.needs.size());
        parallelFor(seconds.size(), [&](IndexRange range) {
            for (std::size_t s = range.begin; s < range.end; ++s)
                seconds[s] = coverBound(coverOf(candidate, s)).seconds;
        });
        return seconds;
    }

    [[nodiscard]] Nanoseconds bound(const Candidate& candidate) const {
        const std::vector<double> seconds = bounds(candidate);
        return added(candidate.darkCost, std::accumulate(seconds.begin(), seconds.end(), 0.0));
    }

    static Nanoseconds added(Nanoseconds cost, double seconds) {
        if (!std::isfinite(seconds)) return Nanoseconds::max();
        return cost + Nanoseconds(static_cast<std::int64_t>(seconds * (1 - 1e-9) * 1e9));
    }

    [[nodiscard]] std::optional<SharedChoice> solve(const Candidate& candidate,
                                                    Nanoseconds limit) const {
        const std::vector<double> least = bounds(candidate);
        const double together = std::accumulate(least.begin(), least.end(), 0.0);
        SharedChoice choice{.darkFrames = candidate.darkFrames,
                            .darks = candidate.exposures,
                            .options = shotOptions(problem_.rig, candidate.darkFrames)};
        if (problem_.rig.darkFramesHeld > 0) choice.darks.clear();
        std::vector<std::optional<Cover>> covers(least.size());
        parallelFor(covers.size(), [&](IndexRange range) {
            for (std::size_t s = range.begin; s < range.end; ++s) {
                const Nanoseconds others = added(candidate.darkCost, together - least[s]);
                const Nanoseconds left = limit == Nanoseconds::max() ? limit : limit - others;
                covers[s] = cheapestCover(coverOf(candidate, s), left);
            }
        });
        choice.cost = candidate.darkCost;
        for (std::size_t s = 0; s < covers.size(); ++s) {
            if (!covers[s]) return std::nullopt;
            choice.cost += covers[s]->cost;
            choice.more.push_back(spread(*covers[s], candidate, choice.options));
        }
        if (choice.cost >= limit) return std::nullopt;
        const CoverProblem everything = coverOf(problem_.rig.exposures);
        for (const CoverShot& shot : everything.shots) choice.have.push_back(shot.have);
        return choice;
    }

    [[nodiscard]] CoverProblem coverOf(const std::vector<Seconds>& exposures) const {
        return coverOf(Candidate{.exposures = exposures}, 0);
    }

    /// Frames of all options, 0 for those of exposures that the candidate leaves out.
    [[nodiscard]] static std::vector<int> spread(const Cover& cover,
                                                 const Candidate& candidate,
                                                 const std::vector<ShotOption>& options) {
        std::vector<int> more;
        std::size_t next = 0;
        for (const ShotOption& option : options) {
            const bool used = contains(candidate.exposures, option.kind.exposure);
            more.push_back(used ? cover.more[next++] : 0);
        }
        return more;
    }

    const SharedProblem& problem_;
    ShotCost cost_;
    std::vector<Seconds> pilots_, others_;
};

}  // namespace

std::vector<ShotOption> shotOptions(const RigModel& rig, int darkFrames) {
    std::vector<ShotOption> options;
    for (const double level : rig.levels) {
        for (const Seconds exposure : rig.exposures)
            options.push_back(
                shotOption(rig.sensor, {.level = level, .exposure = exposure}, darkFrames));
    }
    return options;
}

std::vector<Seconds> pilotExposures(const RigModel& rig) {
    std::vector<Seconds> exposures;
    for (const ShotKind& shot : rig.pilotShots()) {
        if (!contains(exposures, shot.exposure)) exposures.push_back(shot.exposure);
    }
    return exposures;
}

Nanoseconds waitForPlan(const RigModel& rig, int darkFrames) {
    const ShotCost cost(rig.timing);
    Nanoseconds wait = std::chrono::round<Nanoseconds>(rig.timing.transfer + rig.timing.planning);
    if (rig.darkFramesHeld == 0) {
        for (const Seconds exposure : pilotExposures(rig))
            wait -= cost.darkCapture(exposure, darkFrames);
    }
    return std::max(wait, Nanoseconds(0));
}

std::optional<SharedChoice> cheapestChoice(const SharedProblem& problem) {
    return Chooser(problem).best();
}

}  // namespace gonio::proc
