#include "proc/plan/shared_choice.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "proc/core/parallel.h"

namespace gonio::proc {
namespace {

bool contains(const std::vector<Seconds>& list, Seconds exposure) {
    return std::find(list.begin(), list.end(), exposure) != list.end();
}

/// One set of exposures with one number of dark frames.
struct Candidate {
    int darkFrames = 1;
    std::size_t set = 0;             ///< bit i: the i-th exposure that no pilot has
    std::vector<Seconds> exposures;  ///< the pilots' first
    Nanoseconds darkCost{0};         ///< waiting for the plan included

    /// Whatever the other can do, this can do at least as well.
    [[nodiscard]] bool covers(const Candidate& other) const {
        return darkFrames >= other.darkFrames && (set & other.set) == other.set;
    }
};

/// What the states of a candidate cost at least.
struct Known {
    Candidate candidate;
    std::vector<Nanoseconds> least;

    [[nodiscard]] Nanoseconds together() const {
        Nanoseconds sum = candidate.darkCost;
        for (const Nanoseconds cost : least) {
            if (cost == kNever) return kNever;
            sum += cost;
        }
        return sum;
    }
    static constexpr Nanoseconds kNever = Nanoseconds::max();
};

class Chooser {
public:
    explicit Chooser(const SharedProblem& problem)
        : problem_(problem), cost_(problem.rig.timing), pilots_(pilotExposures(problem.rig)) {
        for (const Seconds exposure : problem.rig.exposures) {
            if (!contains(pilots_, exposure)) others_.push_back(exposure);
        }
    }

    /// Always goes on with the candidate that could be the cheapest by all that is known.
    std::optional<SharedChoice> best() {
        std::vector<Known> open;
        for (Candidate& candidate : all()) {
            std::vector<Nanoseconds> nothing(problem_.needs.size(), Nanoseconds(0));
            open.push_back({.candidate = std::move(candidate), .least = std::move(nothing)});
        }
        std::optional<SharedChoice> best;
        while (!open.empty()) {
            const auto next = promising(open);
            const Nanoseconds limit = best ? best->cost : Known::kNever;
            if (next->together() >= limit) {
                open.erase(next);
                continue;
            }
            Known known = std::move(*next);
            open.erase(next);
            if (std::optional<SharedChoice> better = solve(known, limit)) best = std::move(better);
            for (Known& other : open) learn(known, other);
        }
        if (best) best->proven = proven_;
        return best;
    }

private:
    /// First those with all exposures: they bound the others.
    [[nodiscard]] std::vector<Known>::iterator promising(std::vector<Known>& open) const {
        const std::size_t whole = (std::size_t{1} << others_.size()) - 1;
        const auto rank = [&](const Known& known) {
            return std::pair(known.candidate.set == whole ? Nanoseconds(0) : Nanoseconds(1),
                             known.together());
        };
        return std::min_element(open.begin(), open.end(), [&](const Known& a, const Known& b) {
            return rank(a) < rank(b);
        });
    }

    static void learn(const Known& from, Known& about) {
        if (!from.candidate.covers(about.candidate)) return;
        for (std::size_t s = 0; s < about.least.size(); ++s)
            about.least[s] = std::max(about.least[s], from.least[s]);
    }

    [[nodiscard]] std::vector<Candidate> all() const {
        const std::size_t sets = std::size_t{1} << others_.size();
        if (problem_.rig.darkFramesHeld > 0)
            return {candidate(problem_.rig.darkFramesHeld, sets - 1)};
        std::vector<Candidate> candidates;
        for (const int frames : kDarkChoices) {
            for (std::size_t set = sets; set-- > 0;) candidates.push_back(candidate(frames, set));
        }
        return candidates;
    }

    [[nodiscard]] Candidate candidate(int frames, std::size_t set) const {
        Candidate made{.darkFrames = frames, .set = set, .exposures = pilots_};
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

    /// Solves all states, and notes what they cost (or at least cost) in `known`.
    [[nodiscard]] std::optional<SharedChoice> solve(Known& known, Nanoseconds limit) {
        const Candidate& candidate = known.candidate;
        const Nanoseconds together = known.together();
        SharedChoice choice{.darkFrames = candidate.darkFrames,
                            .darks = candidate.exposures,
                            .options = shotOptions(problem_.rig, candidate.darkFrames)};
        if (problem_.rig.darkFramesHeld > 0) choice.darks.clear();
        std::vector<CoverAnswer> covers(known.least.size());
        parallelFor(covers.size(), [&](IndexRange range) {
            for (std::size_t s = range.begin; s < range.end; ++s) {
                const Nanoseconds left =
                    limit == Known::kNever ? limit : limit - (together - known.least[s]);
                covers[s] = cheapestCover(coverOf(candidate, s), left);
                if (!covers[s].proven) continue;  // it may cost less
                known.least[s] = covers[s].cover ? covers[s].cover->cost : left;
            }
        });
        choice.cost = candidate.darkCost;
        for (const CoverAnswer& answer : covers) proven_ = proven_ && answer.proven;
        for (const CoverAnswer& answer : covers) {
            const std::optional<Cover>& cover = answer.cover;
            if (!cover) return std::nullopt;
            choice.cost += cover->cost;
            choice.more.push_back(spread(*cover, candidate, choice.options));
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
    bool proven_ = true;
};

}  // namespace

std::vector<ShotOption> shotOptions(const RigModel& rig, int darkFrames) {
    const std::vector<ShotKind> pilots = rig.pilotShots();
    std::vector<ShotOption> options;
    double brighter = std::numeric_limits<double>::infinity();  // effective time, of a level above
    for (const double level : rig.levels) {
        for (const Seconds exposure : rig.exposures) {
            const ShotKind kind{.level = level, .exposure = exposure};
            const bool piloted = std::find(pilots.begin(), pilots.end(), kind) != pilots.end();
            if (piloted || exposure.count() * level < brighter)
                options.push_back(shotOption(rig.sensor, kind, darkFrames));
        }
        brighter = rig.exposures.front().count() * level;
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
