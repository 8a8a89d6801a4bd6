#include "proc/estimate/error_model.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace gonio::proc {
namespace {

double tensOfDegrees(Radians angle) { return angle.degrees() / 10; }

/// Errors in one unit, each with the square of its standard deviation by noise, and a weight.
class Errors {
public:
    void add(double off, double u, double weight) {
        errors_.push_back({off * off, u * u, weight});
        weight_ += weight;
    }

    /// Empty where there are none.
    [[nodiscard]] std::optional<double> standard() const {
        if (errors_.empty()) return std::nullopt;
        return std::sqrt(std::max({0.0, squareWithin(1), squareWithin(2)}));
    }

private:
    struct Square {
        double off, u, weight;
    };

    /// The square of the standard error of which `k` hold as many errors as they do of a Gaussian.
    [[nodiscard]] double squareWithin(double k) const {
        std::vector<std::pair<double, double>> squares;
        squares.reserve(errors_.size());
        for (const Square& e : errors_) squares.emplace_back(e.off / (k * k) - e.u, e.weight);
        std::sort(squares.begin(), squares.end());
        const double wanted = std::erf(k / std::sqrt(2.0)) * weight_;
        double sum = 0;
        for (const auto& [square, weight] : squares) {
            sum += weight;
            if (sum >= wanted) return square;
        }
        return squares.back().first;
    }

    std::vector<Square> errors_;
    double weight_ = 0;
};

}  // namespace

/// Errors per unit of reach; the farther one reached, the more it counts.
class ErrorModel::PerReach {
public:
    void add(const ProbeError& error, double reach) {
        if (reach <= 0) return;
        const double unit = reach * (error.dark ? 1 : error.toAnswer);
        (error.dark ? dark_ : bright_).add(error.off / unit, error.u / unit, reach * reach);
    }
    /// `other` where there are no errors of a kind.
    [[nodiscard]] Standard standardOr(const Standard& other) const {
        return {.relative = bright_.standard().value_or(other.relative),
                .dark = dark_.standard().value_or(other.dark)};
    }

private:
    Errors bright_, dark_;
};

std::size_t ErrorModel::binOf(Radians fromMirror) {
    std::size_t bin = 0;
    while (bin + 1 < kBins.size() && fromMirror.degrees() > kBins[bin]) ++bin;
    return bin;
}

ErrorModel::ErrorModel(ErrorScale scale, bool anchored, const std::vector<ProbeError>& between)
    : scale_(scale), anchored_(anchored) {
    std::array<PerReach, kBins.size()> bins;
    for (const ProbeError& error : between) {
        bins[binOf(error.fromMirror)].add(error, anchored ? error.reach.between : 1);
    }
    Standard most;
    for (const PerReach& bin : bins) {
        const Standard one = bin.standardOr({});
        most = {.relative = std::max(most.relative, one.relative),
                .dark = std::max(most.dark, one.dark)};
    }
    for (std::size_t k = 0; k < bins.size(); ++k) between_[k] = bins[k].standardOr(most);
}

void ErrorModel::learnBeyondIncidence(const std::vector<ProbeError>& errors) {
    PerReach sum;
    for (const ProbeError& error : errors) {
        sum.add(error, tensOfDegrees(error.reach.beyondIncidence));
    }
    beyondIncidence_ = sum.standardOr({});
}

void ErrorModel::learnEdge(const std::vector<ProbeError>& errors) {
    PerReach sum;
    for (const ProbeError& error : errors) sum.add(error, error.reach.steps / 10);
    steps_ = sum.standardOr({});
}

double ErrorModel::of(double f, std::size_t band, const Reach& reach, Radians fromMirror) const {
    double relative = kLeast * kLeast;
    double dark = 0;
    const auto add = [&](const Standard& error, double times) {
        relative += error.relative * error.relative * times * times;
        dark += error.dark * error.dark * times * times;
    };
    add(between_[binOf(fromMirror)], anchored_ ? reach.between : 1);
    add(beyondIncidence_, tensOfDegrees(reach.beyondIncidence));
    add(steps_, reach.steps / 10);
    return std::hypot(std::sqrt(relative) * scale_.of(f, band),
                      std::sqrt(dark * scale_.darkness(f, band)));
}

}  // namespace gonio::proc
