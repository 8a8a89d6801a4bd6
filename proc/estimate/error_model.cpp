#include "proc/estimate/error_model.h"

#include <cmath>

namespace gonio::proc {
namespace {

/// Error per unit of reach, as the root of a sum of squares over one of reaches.
struct PerReach {
    double error = 0;
    double reach = 0;

    void add(double squared, double at) {
        error += squared;
        reach += at * at;
    }
    [[nodiscard]] double root() const {
        return reach > 0 ? std::sqrt(std::max(0.0, error) / reach) : 0;
    }
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
        bins[binOf(error.fromMirror)].add(error.squared, anchored ? error.reach.between : 1);
    }
    for (std::size_t k = 0; k < bins.size(); ++k) between_[k] = bins[k].root();
}

void ErrorModel::learnBeyondIncidence(const std::vector<ProbeError>& errors) {
    PerReach sum;
    for (const ProbeError& error : errors) {
        sum.add(error.squared, tensOfDegrees(error.reach.beyondIncidence));
    }
    beyondIncidence_ = sum.root();
}

void ErrorModel::learnEdge(const std::vector<ProbeError>& errors) {
    PerReach sum;
    for (const ProbeError& error : errors) sum.add(error.squared, error.reach.steps / 10);
    steps_ = sum.root();
}

double ErrorModel::at(const Reach& reach, Radians fromMirror) const {
    const double inside = between_[binOf(fromMirror)] * (anchored_ ? reach.between : 1);
    const double incidence = beyondIncidence_ * tensOfDegrees(reach.beyondIncidence);
    return std::hypot(std::hypot(inside, incidence), std::hypot(steps_ * reach.steps / 10, kLeast));
}

}  // namespace gonio::proc
