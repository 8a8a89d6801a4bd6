#include "proc/plan/prediction.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gonio::proc {
namespace {

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
    std::sort(values.begin(), values.end(), [](const Counted& a, const Counted& b) {
        return a.value < b.value;
    });
    double all = 0;
    for (const Counted& v : values) all += v.count;
    const auto quantile = [&](double share) {
        double below = 0;
        for (const Counted& v : values) {
            below += v.count;
            if (below >= share * all) return v.value;
        }
        return values.back().value;
    };
    return {.worst = values.back().value, .percentile95 = quantile(0.95), .median = quantile(0.5)};
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
