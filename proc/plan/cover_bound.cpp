#include "proc/plan/cover_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace gonio::proc {
namespace {

constexpr double kEps = 1e-12;

/// The dual's tableau: a row per shot, a column per need (whose y is scaled by what it lacks) and
/// one per slack; the objective's reduced costs and the right-hand side beside them.
class Tableau {
public:
    Tableau(const CoverProblem& problem, const std::vector<double>& lacking)
        : rows_(problem.shots.size()), needs_(lacking.size()), columns_(needs_ + rows_) {
        cells_.assign(rows_ * columns_, 0);
        gain_.assign(columns_, 0);
        for (std::size_t g = 0; g < rows_; ++g) {
            const CoverShot& shot = problem.shots[g];
            for (std::size_t j = 0; j < needs_; ++j) {
                if (lacking[j] <= 0) continue;
                at(g, j) = shot.option.idealInformation(problem.needs[j].rate) / lacking[j];
                gain_[j] = 1;
            }
            at(g, needs_ + g) = 1;
            limit_.push_back(Seconds(shot.frame).count());
            basis_.push_back(needs_ + g);
        }
    }

    /// False: unbounded, some need cannot be met.
    bool solve() {
        const std::size_t steps = 50 * (columns_ + 1);
        for (std::size_t step = 0; step < steps; ++step) {
            const std::optional<std::size_t> in = entering();
            if (!in) return true;
            const std::optional<std::size_t> out = leaving(*in);
            if (!out) return false;
            pivot(*out, *in);
        }
        return true;
    }

    [[nodiscard]] std::vector<double> values() const {
        std::vector<double> y(needs_, 0.0);
        for (std::size_t g = 0; g < rows_; ++g) {
            if (basis_[g] < needs_) y[basis_[g]] = std::max(0.0, limit_[g]);
        }
        return y;
    }

private:
    double& at(std::size_t row, std::size_t column) { return cells_[row * columns_ + column]; }

    [[nodiscard]] std::optional<std::size_t> entering() const {
        const auto best = std::max_element(gain_.begin(), gain_.end());
        if (!(*best > kEps)) return std::nullopt;
        return static_cast<std::size_t>(best - gain_.begin());
    }

    std::optional<std::size_t> leaving(std::size_t column) {
        std::optional<std::size_t> best;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t g = 0; g < rows_; ++g) {
            if (!(at(g, column) > kEps)) continue;
            const double ratio = limit_[g] / at(g, column);
            if (ratio < least) {
                least = ratio;
                best = g;
            }
        }
        return best;
    }

    void pivot(std::size_t row, std::size_t column) {
        const double by = at(row, column);
        for (std::size_t c = 0; c < columns_; ++c) at(row, c) /= by;
        limit_[row] /= by;
        for (std::size_t g = 0; g < rows_; ++g) {
            const double factor = at(g, column);
            if (g == row || factor == 0) continue;
            for (std::size_t c = 0; c < columns_; ++c) at(g, c) -= factor * at(row, c);
            limit_[g] -= factor * limit_[row];
        }
        const double factor = gain_[column];
        for (std::size_t c = 0; c < columns_; ++c) gain_[c] -= factor * at(row, c);
        basis_[row] = column;
    }

    std::size_t rows_, needs_, columns_;
    std::vector<double> cells_;
    std::vector<double> gain_;   // by column
    std::vector<double> limit_;  // by row: seconds
    std::vector<std::size_t> basis_;
};

/// Rounding in the pivots may leave a constraint exceeded: shrinks y until none is.
void makeFeasible(const CoverProblem& problem, std::vector<double>& prices) {
    double most = 1;
    for (const CoverShot& shot : problem.shots) {
        double worth = 0;
        for (std::size_t j = 0; j < prices.size(); ++j)
            worth += prices[j] * shot.option.idealInformation(problem.needs[j].rate);
        most = std::max(most, worth / Seconds(shot.frame).count());
    }
    for (double& price : prices) price /= most;
}

}  // namespace

double informationAtHand(const CoverProblem& problem, const CoverNeed& need) {
    double sum = 0;
    for (const CoverShot& shot : problem.shots)
        sum += shot.option.information(need.rate, shot.have);
    return sum;
}

CoverBound coverBound(const CoverProblem& problem) {
    std::vector<double> lacking;
    for (const CoverNeed& need : problem.needs)
        lacking.push_back(std::max(0.0, need.information - informationAtHand(problem, need)));
    Tableau tableau(problem, lacking);
    if (!tableau.solve()) {
        return {.seconds = std::numeric_limits<double>::infinity(),
                .prices = std::vector<double>(lacking.size(), 0.0)};
    }
    CoverBound bound{.seconds = 0, .prices = tableau.values()};
    for (std::size_t j = 0; j < lacking.size(); ++j)
        bound.prices[j] = lacking[j] > 0 ? bound.prices[j] / lacking[j] : 0;
    makeFeasible(problem, bound.prices);
    for (std::size_t j = 0; j < lacking.size(); ++j) bound.seconds += bound.prices[j] * lacking[j];
    return bound;
}

}  // namespace gonio::proc
