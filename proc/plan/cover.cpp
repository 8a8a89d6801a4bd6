#include "proc/plan/cover.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "proc/plan/cover_bound.h"
#include "proc/plan/light_bound.h"

namespace gonio::proc {
namespace {

/// Labels kept after each shot in the pass that only looks for a good answer.
constexpr std::size_t kNarrow = 8;
/// Frames beyond the least that such a pass tries of a shot.
constexpr int kFewMore = 15;
/// And in the last: all, unless there are more than a plan may wait for.
constexpr std::size_t kWide = 1000;
/// Of a few sums and quotients, relative.
constexpr double kRounding = 1e-9;

/// What one label chose at one shot, and from which label before.
struct Choice {
    std::size_t from = 0;
    int more = 0;
};

struct Label {
    Nanoseconds cost{0};
    Nanoseconds least{0};      ///< of a whole answer that goes on from here
    double effective = 0;      ///< seconds at full level, of all frames of the shots decided
    std::vector<int> lacking;  ///< units of each need, never below 0
    Choice choice;
};

bool dominates(const Label& a, const Label& b) {
    for (std::size_t j = 0; j < a.lacking.size(); ++j) {
        if (a.lacking[j] > b.lacking[j]) return false;
    }
    return true;
}

/// Without those that another dominates, by cost; the most promising `width` of them.
struct Thinned {
    std::vector<Label> labels;
    bool all = true;  ///< none was dropped for want of width
};
Thinned thinned(std::vector<Label> labels, std::size_t width) {
    const auto promising = [](const Label& a, const Label& b) { return a.least < b.least; };
    std::stable_sort(labels.begin(), labels.end(), [](const Label& a, const Label& b) {
        return a.cost < b.cost;
    });
    std::vector<Label> kept;
    for (Label& label : labels) {
        const bool beaten = std::any_of(
            kept.begin(), kept.end(), [&](const Label& k) { return dominates(k, label); });
        if (!beaten) kept.push_back(std::move(label));
    }
    if (kept.size() > width) {
        std::stable_sort(kept.begin(), kept.end(), promising);
        kept.resize(width);
        return {.labels = std::move(kept), .all = false};
    }
    return {.labels = std::move(kept)};
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
        for (std::size_t j = 0; j < problem.needs.size(); ++j)
            unit_ += prices_.prices[j] * problem.needs[j].information / kNeedUnits;
        for (const CoverNeed& need : problem.needs) {
            const auto sees = [&](std::size_t g) {
                return need.rate <= problem.shots[g].option.reach;
            };
            due_.push_back(static_cast<std::size_t>(
                std::find_if_not(order_.begin(), order_.end(), sees) - order_.begin()));
        }
        readRoundedAway();
    }

    /// The best that costs less than `limit`, of the labels within `width`. `light` may be null.
    std::optional<Cover> run(Nanoseconds limit, std::size_t width, const LightBound* light) {
        if (!std::isfinite(prices_.seconds)) return std::nullopt;
        std::vector<Label> labels{start()};
        for (std::size_t j = 0; j < due_.size(); ++j) {
            if (due_[j] == 0 && labels.front().lacking[j] > 0) return std::nullopt;
        }
        std::vector<std::vector<Choice>> history;
        proven_ = true;
        for (std::size_t k = 0; k < order_.size() && !labels.empty(); ++k) {
            std::vector<Label> next;
            for (std::size_t i = 0; i < labels.size(); ++i)
                extend(labels[i], {.index = i, .shot = k, .limit = limit}, light, next);
            Thinned thin = thinned(std::move(next), width);
            labels = std::move(thin.labels);
            proven_ = proven_ && thin.all;
            history.emplace_back();
            for (const Label& label : labels) history.back().push_back(label.choice);
        }
        if (labels.empty()) return std::nullopt;
        return traced(labels, history);
    }

    /// Whether the last run dropped only what cannot be the best.
    [[nodiscard]] bool proven() const { return proven_; }
    [[nodiscard]] LightBound lightBound(Nanoseconds most) const {
        return {problem_, order_, due_, most};
    }

private:
    /// What the frames at hand leave to be wanted.
    [[nodiscard]] Label start() const {
        Label label;
        for (const CoverNeed& need : problem_.needs) {
            int units = 0;
            for (const CoverShot& shot : problem_.shots)
                units += needUnits(shot.option, need, shot.have);
            label.lacking.push_back(std::max(0, kNeedUnits - units));
        }
        for (const CoverShot& shot : problem_.shots) label.effective += shot.have * shot.option.tau;
        return label;
    }

    /// Where the search is.
    struct Place {
        std::size_t index = 0;  ///< of the label
        std::size_t shot = 0;   ///< in the order
        Nanoseconds limit{0};
    };
    /// All numbers of frames of a shot that may belong to a best answer.
    void extend(const Label& label,
                const Place& at,
                const LightBound* light,
                std::vector<Label>& next) const {
        const CoverShot& shot = problem_.shots[order_[at.shot]];
        const Span span = usefulFrames(label, at.shot);
        // Without a bound a narrow pass would try up to maxFrames of everything.
        const int most = light == nullptr ? std::min(span.most, span.least + kFewMore) : span.most;
        for (int more = span.least; more <= most; ++more) {
            const Nanoseconds cost = label.cost + shot.cost(more);
            if (cost >= at.limit) break;
            const double effective = label.effective + (shot.have + more) * shot.option.tau;
            const Nanoseconds whole =
                light == nullptr ? Nanoseconds(0) : light->from(at.shot + 1, effective);
            if (whole >= at.limit - cost) continue;
            Label reached{.cost = cost,
                          .effective = effective,
                          .lacking = label.lacking,
                          .choice = {.from = at.index, .more = more}};
            spend(reached, shot, more);
            const double relaxed = remaining(reached, at.shot + 1);
            const double allowed = Seconds(at.limit - cost).count();
            // With more frames the sum only rises, but for the rounding of what they tell.
            if (relaxed - unit_ >= allowed) break;
            if (relaxed >= allowed) continue;
            reached.least = cost + std::max(whole, rounded(relaxed));
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
            if (label.lacking[j] == 0) continue;
            const CoverNeed& need = problem_.needs[j];
            const int units = label.lacking[j] + needUnits(shot.option, need, shot.have);
            const double wanted = need.information * units / kNeedUnits;
            const double frames = shot.option.framesFor(need.rate, wanted * (1 - kRounding));
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
            if (label.lacking[j] == 0) continue;
            const CoverNeed& need = problem_.needs[j];
            const int gained = needUnits(shot.option, need, shot.have + more) -
                               needUnits(shot.option, need, shot.have);
            label.lacking[j] = std::max(0, label.lacking[j] - gained);
        }
    }

    /// What more frames of the shots from each on may tell each need beyond their own, in units:
    /// what was rounded away of the frames that these shots have.
    void readRoundedAway() {
        const std::size_t needs = problem_.needs.size();
        roundedAway_.assign(order_.size() + 1, std::vector<double>(needs, 0.0));
        for (std::size_t k = order_.size(); k-- > 0;) {
            const CoverShot& shot = problem_.shots[order_[k]];
            for (std::size_t j = 0; j < needs; ++j) {
                const CoverNeed& need = problem_.needs[j];
                const double share =
                    shot.option.information(need.rate, shot.have) / need.information;
                const double exact = std::min(1.0, share) * kNeedUnits;
                const double lost = exact - needUnits(shot.option, need, shot.have);
                roundedAway_[k][j] = roundedAway_[k + 1][j] + std::max(0.0, lost);
            }
        }
    }

    /// What the rest costs at least, of the shots from `shot` on: seconds.
    [[nodiscard]] double remaining(const Label& label, std::size_t shot) const {
        double seconds = 0;
        for (std::size_t j = 0; j < label.lacking.size(); ++j) {
            const double units = std::max(0.0, label.lacking[j] - roundedAway_[shot][j]);
            seconds += prices_.prices[j] * problem_.needs[j].information * units / kNeedUnits;
        }
        return seconds * (1 - kRounding);  // below what rounding in the sums could add
    }

    [[nodiscard]] static Nanoseconds rounded(double seconds) {
        return Nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
    }

    /// The cheapest of the labels after the last shot, followed back.
    [[nodiscard]] Cover traced(const std::vector<Label>& last,
                               const std::vector<std::vector<Choice>>& history) const {
        const auto cheapest =
            std::min_element(last.begin(), last.end(), [](const Label& a, const Label& b) {
                return a.cost < b.cost;
            });
        Cover cover{.more = std::vector<int>(order_.size(), 0), .cost = cheapest->cost};
        auto at = static_cast<std::size_t>(cheapest - last.begin());
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
    double unit_ = 0;                               // seconds that one unit of every need is worth
    std::vector<std::vector<double>> roundedAway_;  // from each shot on, of each need: units
    bool proven_ = true;
};

bool met(const CoverProblem& problem, const std::vector<int>& more) {
    for (const CoverNeed& need : problem.needs) {
        int units = 0;
        for (std::size_t g = 0; g < more.size(); ++g) {
            const CoverShot& shot = problem.shots[g];
            units += needUnits(shot.option, need, shot.have + more[g]);
        }
        if (units < kNeedUnits) return false;
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

/// More than maxFrames of every shot cost.
Nanoseconds everything(const CoverProblem& problem) {
    Nanoseconds sum(1);
    for (const CoverShot& shot : problem.shots) sum += shot.cost(problem.maxFrames);
    return sum;
}

/// How many of the shots see a pixel of this rate.
std::size_t seenBy(const std::vector<CoverShot>& shots, double rate) {
    return static_cast<std::size_t>(std::count_if(
        shots.begin(), shots.end(), [&](const CoverShot& s) { return rate <= s.option.reach; }));
}

}  // namespace

CoverAnswer cheapestCover(const CoverProblem& problem, Nanoseconds limit) {
    const CoverProblem small{.shots = problem.shots,
                             .needs = essentialNeeds(problem.shots, problem.needs),
                             .maxFrames = problem.maxFrames};
    Search search(small);
    std::optional<Cover> best = search.run(limit, kNarrow, nullptr);
    const auto most = [&] { return best ? best->cost : limit; };
    std::optional<LightBound> light;
    if (most() < Nanoseconds::max()) light = search.lightBound(most());
    if (!light) light = search.lightBound(everything(problem));
    std::optional<Cover> better = search.run(most(), kWide, &*light);
    if (better) best = std::move(better);
    return {.cover = std::move(best), .proven = search.proven()};
}

int needUnits(const ShotOption& shot, const CoverNeed& need, int frames) {
    const double share = shot.information(need.rate, frames) / need.information;
    return static_cast<int>(std::min(1.0, share * (1 + kRounding)) * kNeedUnits);
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
