#include "proc/estimate/error_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gonio::proc {
namespace {

/// Errors per unit of reach; the farther one reached, the more it counts.
class PerReach {
public:
    void add(const ProbeError& error, double reach) {
        if (reach <= 0) return;
        const double off = error.off / (error.toAnswer * reach);
        const double u = error.u / (error.toAnswer * reach);
        errors_.push_back({off * off, u * u, reach * reach});
        weight_ += reach * reach;
    }

    [[nodiscard]] bool empty() const { return errors_.empty(); }
    [[nodiscard]] double standard() const {
        return std::sqrt(std::max({0.0, squareWithin(1), squareWithin(2)}));
    }

private:
    struct Square {
        double off, u, weight;
    };

    /// The square of the standard error of which `k` hold as many errors as they do of a Gaussian.
    [[nodiscard]] double squareWithin(double k) const {
        std::vector<std::pair<double, double>> squares;
        for (const Square& e : errors_) squares.emplace_back(e.off / (k * k) - e.u, e.weight);
        std::sort(squares.begin(), squares.end());
        const double wanted = std::erf(k / std::sqrt(2.0)) * weight_;
        double sum = 0;
        for (const auto& [square, weight] : squares) {
            sum += weight;
            if (sum >= wanted) return square;
        }
        return squares.empty() ? 0 : squares.back().first;
    }

    std::vector<Square> errors_;
    double weight_ = 0;
};

double tensOfDegrees(Radians angle) { return angle.degrees() / 10; }

}  // namespace

std::size_t ErrorModel::binOf(Radians fromMirror) {
    std::size_t bin = 0;
    while (bin + 1 < kBins.size() && fromMirror.degrees() > kBins[bin]) ++bin;
    return bin;
}

ErrorModel::ErrorModel(bool anchored, const std::vector<ProbeError>& between)
    : anchored_(anchored) {
    std::array<PerReach, kBins.size()> bins;
    for (const ProbeError& error : between) {
        bins[binOf(error.fromMirror)].add(error, anchored ? error.reach.between : 1);
    }
    double most = 0;
    for (std::size_t k = 0; k < bins.size(); ++k) {
        between_[k] = bins[k].standard();
        most = std::max(most, between_[k]);
    }
    for (std::size_t k = 0; k < bins.size(); ++k) {
        if (bins[k].empty()) between_[k] = most;
    }
}

void ErrorModel::learnBeyondIncidence(const std::vector<ProbeError>& errors) {
    PerReach sum;
    for (const ProbeError& error : errors) {
        sum.add(error, tensOfDegrees(error.reach.beyondIncidence));
    }
    beyondIncidence_ = sum.standard();
}

void ErrorModel::learnEdge(const std::vector<ProbeError>& errors) {
    PerReach sum;
    for (const ProbeError& error : errors) sum.add(error, error.reach.steps / 10);
    steps_ = sum.standard();
}

double ErrorModel::at(const Reach& reach, Radians fromMirror) const {
    const double inside = between_[binOf(fromMirror)] * (anchored_ ? reach.between : 1);
    const double incidence = beyondIncidence_ * tensOfDegrees(reach.beyondIncidence);
    return std::hypot(std::hypot(inside, incidence), std::hypot(steps_ * reach.steps / 10, kLeast));
}

}  // namespace gonio::proc
