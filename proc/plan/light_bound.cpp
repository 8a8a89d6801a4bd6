#include "proc/plan/light_bound.h"

#include <algorithm>
#include <limits>

namespace gonio::proc {

LightBound::LightBound(const CoverProblem& problem,
                       const std::vector<std::size_t>& order,
                       const std::vector<std::size_t>& due,
                       Nanoseconds most)
    : most_(most), stairs_(order.size() + 1) {
    constexpr double kRounding = 1 - 1e-6;  // sums in another order, and needs met within 1e-9
    std::vector<double> needed(order.size() + 1, 0.0);
    for (std::size_t j = 0; j < due.size(); ++j) {
        const CoverNeed& need = problem.needs[j];
        needed[due[j]] =
            std::max(needed[due[j]], std::max(need.rate, 0.0) * need.information * kRounding);
    }
    constexpr double kWhatever = -std::numeric_limits<double>::infinity();
    stairs_.back() = {{.effective = kWhatever}};
    for (std::size_t k = order.size(); k-- > 0;) {
        const CoverShot& shot = problem.shots[order[k]];
        stairs_[k] = before(shot, needed[k + 1], stairs_[k + 1], most, problem.maxFrames);
    }
}

LightBound::Stairs LightBound::before(
    const CoverShot& shot, double needed, const Stairs& after, Nanoseconds most, int maxFrames) {
    Stairs stairs;
    if (after.empty()) return stairs;
    const double enough = std::max(needed, after.front().effective);
    for (int more = 0; more <= maxFrames; ++more) {
        const double gained = (shot.have + more) * shot.option.tau;
        Stairs with;
        for (const Step& step : after) {
            const Nanoseconds cost = step.cost + shot.cost(more);
            if (cost >= most) break;
            with.push_back({std::max(step.effective, needed) - gained, cost});
        }
        if (with.empty()) break;
        stairs = lower(stairs, with);
        if (gained >= enough) break;
    }
    return stairs;
}

/// The lower of the two, everywhere.
LightBound::Stairs LightBound::lower(const Stairs& a, const Stairs& b) {
    Stairs both(a.size() + b.size());
    std::merge(a.begin(), a.end(), b.begin(), b.end(), both.begin(), [](auto& x, auto& y) {
        return x.cost != y.cost ? x.cost < y.cost : x.effective < y.effective;
    });
    Stairs kept;
    for (const Step& step : both) {
        if (kept.empty() || step.effective < kept.back().effective) kept.push_back(step);
    }
    return kept;
}

Nanoseconds LightBound::from(std::size_t k, double effectiveSeconds) const {
    const Stairs& stairs = stairs_[k];
    const auto step = std::partition_point(stairs.begin(), stairs.end(), [&](const Step& s) {
        return s.effective > effectiveSeconds;
    });
    return step == stairs.end() ? most_ : step->cost;
}

}  // namespace gonio::proc
