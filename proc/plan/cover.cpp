#include "proc/plan/cover.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "proc/plan/cover_bound.h"

namespace gonio::proc {
namespace {

/// Labels kept after each shot in the first, narrow pass, which finds a good answer quickly.
constexpr std::size_t kNarrow = 8;
/// Sums of informations in another order differ by rounding: a need is met within this share.
constexpr double kMet = 1 - 1e-9;

/// What one label chose at one shot, and from which label before.
struct Choice {
    std::size_t from = 0;
    int more = 0;
};

struct Label {
    Nanoseconds cost{0};
    std::vector<double> lacking;  ///< of each need, never below 0
    Choice choice;
};

bool dominates(const Label& a, const Label& b) {
    for (std::size_t j = 0; j < a.lacking.size(); ++j) {
        if (a.lacking[j] > b.lacking[j]) return false;
    }
    return true;
}

/// By cost; without those that an earlier one dominates; at most `width`.
std::vector<Label> thinned(std::vector<Label> labels, std::size_t width) {
    std::stable_sort(labels.begin(), labels.end(), [](const Label& a, const Label& b) {
        return a.cost < b.cost;
    });
    std::vector<Label> kept;
    for (Label& label : labels) {
        if (kept.size() == width) break;
        const bool beaten = std::any_of(
            kept.begin(), kept.end(), [&](const Label& k) { return dominates(k, label); });
        if (!beaten) kept.push_back(std::move(label));
    }
    return kept;
}

class Search {
public:
    explicit Search(const CoverProblem& problem) : problem_(problem) {
        order_.resize(problem.shots.size());
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
            return problem.shots[a].option.reach > problem.shots[b].option.reach;
        });
        prices_ = coverBound(problem);
        for (const CoverNeed& need : problem.needs) {
            const auto sees = [&](std::size_t g) {
                return need.rate <= problem.shots[g].option.reach;
            };
            due_.push_back(static_cast<std::size_t>(
                std::find_if_not(order_.begin(), order_.end(), sees) - order_.begin()));
        }
    }

    /// The best that costs less than `limit`, of the labels within `width`.
    std::optional<Cover> run(Nanoseconds limit, std::size_t width) {
        Label start;
        for (const CoverNeed& need : problem_.needs)
            start.lacking.push_back(
                lack(need.information, informationAtHand(problem_, need), need));
        for (std::size_t j = 0; j < due_.size(); ++j) {
            if (due_[j] == 0 && start.lacking[j] > 0) return std::nullopt;
        }
        if (!std::isfinite(prices_.seconds)) return std::nullopt;
        std::vector<Label> labels{std::move(start)};
        std::vector<std::vector<Choice>> history;
        for (std::size_t k = 0; k < order_.size() && !labels.empty(); ++k) {
            std::vector<Label> next;
            for (std::size_t i = 0; i < labels.size(); ++i) extend(labels[i], i, k, limit, next);
            labels = thinned(std::move(next), width);
            history.emplace_back();
            for (const Label& label : labels) history.back().push_back(label.choice);
        }
        if (labels.empty()) return std::nullopt;
        return traced(labels.front().cost, history);
    }

private:
    static double lack(double wanted, double has, const CoverNeed& need) {
        const double left = wanted - has;
        return left > (1 - kMet) * need.information ? left : 0;
    }

    /// All numbers of frames of the k-th shot that may belong to a best answer.
    void extend(const Label& label,
                std::size_t index,
                std::size_t k,
                Nanoseconds limit,
                std::vector<Label>& next) const {
        const CoverShot& shot = problem_.shots[order_[k]];
        const Span span = usefulFrames(label, k);
        for (int more = span.least; more <= span.most; ++more) {
            Label reached{.cost = label.cost + shot.cost(more),
                          .lacking = label.lacking,
                          .choice = {.from = index, .more = more}};
            spend(reached, shot, more);
            if (reached.cost + remaining(reached) >= limit) break;  // more frames: costs rise only
            next.push_back(std::move(reached));
        }
    }

    struct Span {
        int least = 0;
        int most = 0;
    };
    /// From what the needs that are due want, to where no need wants more.
    [[nodiscard]] Span usefulFrames(const Label& label, std::size_t k) const {
        const CoverShot& shot = problem_.shots[order_[k]];
        double least = 0;
        double most = 0;
        for (std::size_t j = 0; j < due_.size(); ++j) {
            if (label.lacking[j] <= 0) continue;
            const double rate = problem_.needs[j].rate;
            const double has = shot.option.information(rate, shot.have);
            const double frames = shot.option.framesFor(rate, has + label.lacking[j]);
            const double more = frames > 0 ? std::max(0.0, frames - shot.have) : kNever;
            most = std::max(most, more);
            if (due_[j] == k + 1) least = std::max(least, more);
        }
        if (least > problem_.maxFrames) return {.least = 1, .most = 0};
        return {.least = static_cast<int>(least),
                .most = static_cast<int>(std::min<double>(most, problem_.maxFrames))};
    }

    void spend(Label& label, const CoverShot& shot, int more) const {
        if (more == 0) return;
        for (std::size_t j = 0; j < label.lacking.size(); ++j) {
            if (label.lacking[j] <= 0) continue;
            const CoverNeed& need = problem_.needs[j];
            const double gained = shot.option.information(need.rate, shot.have + more) -
                                  shot.option.information(need.rate, shot.have);
            label.lacking[j] = lack(label.lacking[j], gained, need);
        }
    }

    /// What the rest costs at least.
    [[nodiscard]] Nanoseconds remaining(const Label& label) const {
        double seconds = 0;
        for (std::size_t j = 0; j < label.lacking.size(); ++j)
            seconds += prices_.prices[j] * label.lacking[j];
        // Rounded down, and below what rounding in the sums could add.
        return Nanoseconds(static_cast<std::int64_t>(seconds * (1 - 1e-9) * 1e9));
    }

    [[nodiscard]] Cover traced(Nanoseconds cost,
                               const std::vector<std::vector<Choice>>& history) const {
        Cover cover{.more = std::vector<int>(order_.size(), 0), .cost = cost};
        std::size_t at = 0;
        for (std::size_t k = history.size(); k-- > 0;) {
            const Choice& choice = history[k][at];
            cover.more[order_[k]] = choice.more;
            at = choice.from;
        }
        return cover;
    }

    static constexpr double kNever = std::numeric_limits<double>::infinity();

    const CoverProblem& problem_;
    std::vector<std::size_t> order_;  // shots by falling reach
    std::vector<std::size_t> due_;    // of each need: how many of them see its pixel
    CoverBound prices_;
};

bool met(const CoverProblem& problem, const std::vector<int>& more) {
    for (const CoverNeed& need : problem.needs) {
        double sum = 0;
        for (std::size_t g = 0; g < more.size(); ++g) {
            const CoverShot& shot = problem.shots[g];
            sum += shot.option.information(need.rate, shot.have + more[g]);
        }
        if (sum < need.information * kMet) return false;
    }
    return true;
}

/// The number after this in a number system of base maxFrames + 1; false after the last.
bool countUp(std::vector<int>& digits, int maxFrames) {
    for (int& digit : digits) {
        if (digit < maxFrames) {
            ++digit;
            return true;
        }
        digit = 0;
    }
    return false;
}

/// How many of the shots see a pixel of this rate.
std::size_t seenBy(const std::vector<CoverShot>& shots, double rate) {
    return static_cast<std::size_t>(std::count_if(
        shots.begin(), shots.end(), [&](const CoverShot& s) { return rate <= s.option.reach; }));
}

}  // namespace

std::optional<Cover> cheapestCover(const CoverProblem& problem, Nanoseconds limit) {
    const CoverProblem small{.shots = problem.shots,
                             .needs = essentialNeeds(problem.shots, problem.needs),
                             .maxFrames = problem.maxFrames};
    Search search(small);
    const std::optional<Cover> first = search.run(limit, kNarrow);
    const std::size_t all = std::numeric_limits<std::size_t>::max();
    std::optional<Cover> best = search.run(first ? first->cost : limit, all);
    return best ? best : first;
}

std::optional<Cover> cheapestCoverReference(const CoverProblem& problem) {
    std::optional<Cover> best;
    std::vector<int> more(problem.shots.size(), 0);
    do {
        Nanoseconds cost{0};
        for (std::size_t g = 0; g < more.size(); ++g) cost += problem.shots[g].cost(more[g]);
        if ((!best || cost < best->cost) && met(problem, more))
            best = Cover{.more = more, .cost = cost};
    } while (countUp(more, problem.maxFrames));
    return best;
}

std::vector<CoverNeed> essentialNeeds(const std::vector<CoverShot>& shots,
                                      std::vector<CoverNeed> needs) {
    // b implies a where it wants as much of more light; or where both are seen by the same shots
    // and it wants so much more of less light: information falls with the rate, but no faster than
    // as 1 / rate.
    std::sort(needs.begin(), needs.end(), [](const CoverNeed& a, const CoverNeed& b) {
        return a.rate != b.rate ? a.rate > b.rate : a.information > b.information;
    });
    std::vector<CoverNeed> fallen;  // without those that a brighter one implies, of any band
    double most = -1;
    for (const CoverNeed& need : needs) {
        if (need.information <= most) continue;
        most = need.information;
        fallen.push_back(need);
    }
    std::vector<CoverNeed> kept;  // nor a dimmer one
    std::size_t band = 0;
    for (auto need = fallen.rbegin(); need != fallen.rend(); ++need) {
        const std::size_t seen = seenBy(shots, need->rate);
        if (kept.empty() || seen != band) most = -1;
        band = seen;
        const double product = need->information * std::max(need->rate, 0.0);
        if (product <= most) continue;
        most = product;
        kept.push_back(*need);
    }
    return kept;
}

}  // namespace gonio::proc
