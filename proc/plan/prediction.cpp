#include "proc/plan/prediction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace gonio::proc {
namespace {

/// The smallest of the values that `wanted` of the counts do not exceed. Halves what is left of
/// them until it is one, which sorting all would take ten times as long for.
double quantile(std::span<Counted> values, double wanted) {
    while (values.size() > 1) {
        const std::size_t half = values.size() / 2;
        std::ranges::nth_element(
            values, values.begin() + static_cast<std::ptrdiff_t>(half), {}, &Counted::value);
        double below = 0;
        for (const Counted& v : values.first(half)) below += v.count;
        if (below >= wanted) {
            values = values.first(half);
        } else {
            values = values.subspan(half);
            wanted -= below;
        }
    }
    return values.front().value;
}

double relative(const PlanCell& cell, double information) {
    if (!(information > 0)) return std::numeric_limits<double>::infinity();
    return 1 / (std::sqrt(cell.pixels * information) * cell.signal());
}

}  // namespace

double randomUncertainty(const PlanCell& cell, const StateFrames& taken) {
    double information = 0;
    for (std::size_t g = 0; g < taken.options.size(); ++g)
        information += taken.options[g].information(cell.rate, taken.frames[g]);
    return relative(cell, information);
}

double cramerRaoUncertainty(const PlanCell& cell, const StateFrames& taken) {
    double information = 0;
    for (std::size_t g = 0; g < taken.options.size(); ++g)
        information += taken.frames[g] * taken.options[g].idealInformation(cell.rate);
    return relative(cell, information);
}

Spread spreadOf(std::vector<Counted> values) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (values.empty()) return {nan, nan, nan};
    double all = 0;
    for (const Counted& v : values) all += v.count;
    const double worst = std::ranges::max_element(values, {}, &Counted::value)->value;
    const double median = quantile(values, 0.5 * all);
    return {.worst = worst, .percentile95 = quantile(values, 0.95 * all), .median = median};
}

void PredictionSum::reserve(std::size_t cells) {
    for (std::vector<Counted>* const values : {&random_, &systematic_, &total_, &cramerRao_})
        values->reserve(cells);
}

void PredictionSum::add(const PlanCell& cell, const StateFrames& taken) {
    const double random = randomUncertainty(cell, taken);
    const double systematic = floor_.at(cell.f) / cell.f;
    random_.push_back({random, cell.count});
    systematic_.push_back({systematic, cell.count});
    total_.push_back({std::hypot(random, systematic), cell.count});
    cramerRao_.push_back({cramerRaoUncertainty(cell, taken), cell.count});
}

Prediction PredictionSum::result() const {
    Prediction sum{.random = spreadOf(random_),
                   .systematic = spreadOf(systematic_),
                   .total = spreadOf(total_),
                   .cramerRao = spreadOf(cramerRao_)};
    for (const Counted& v : random_) sum.cells += static_cast<std::size_t>(v.count);
    return sum;
}

}  // namespace gonio::proc
