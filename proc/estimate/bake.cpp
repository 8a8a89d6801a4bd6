#include "proc/estimate/bake.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "proc/core/coordinates.h"
#include "proc/core/parallel.h"

namespace gonio::proc {
namespace {

constexpr double kOffHorizon = 1e-3;
constexpr double kLeastLog2 = -30;
constexpr double kLargestHalf = 65504;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

using Stored = std::array<float, 3>;

/// The pair at a point of LobeBox, in the plane phi_h = 0, at or just above the horizon.
LightView pairAt(const BoxPoint<double>& point) {
    const double m = std::clamp(point.cosDiff, kOffHorizon, 1.0);
    const double tanDiff = std::sqrt((1 - m) * (1 + m)) / m;
    const double product = point.tanHalf * tanDiff;
    const double q = std::min(point.skew * std::min(1.0, product), 1 - kOffHorizon);
    const double cosPhi = product > 0 ? std::min(1.0, q / product) : point.skew;
    return fromHalfDifference({.thetaHalf = Radians(std::atan(point.tanHalf)),
                               .phiHalf = Radians(0),
                               .thetaDiff = Radians(std::atan(tanDiff)),
                               .phiDiff = Radians(kPi - std::acos(cosPhi))});
}

/// The place of a node or of a cell along the three axes.
struct Corner {
    int tanHalf, cosDiff, skew;

    Corner(std::size_t number, const BoxResolution& count)
        : tanHalf(0), cosDiff(0), skew(static_cast<int>(number) % count.skew) {
        const int rest = static_cast<int>(number) / count.skew;
        cosDiff = rest % count.cosDiff;
        tanHalf = rest / count.cosDiff;
    }
    [[nodiscard]] BoxPoint<double> shifted(double by) const {
        return {tanHalf + by, cosDiff + by, skew + by};
    }
};

std::size_t numberOf(const BoxResolution& count, int tanHalf, int cosDiff, int skew) {
    return static_cast<std::size_t>((tanHalf * count.cosDiff + cosDiff) * count.skew + skew);
}

class Baking {
public:
    Baking(const Scatterer& truth, const AnalyticModel* carrier, const BoxAxes& axes)
        : truth_(truth), carrier_(carrier), axes_(axes), count_(axes.resolution()) {}

    /// What each node stores, in the precision that it will be stored in.
    [[nodiscard]] std::vector<Stored> values(TableStorage storage) const {
        std::vector<Stored> all(count_.nodes());
        parallelFor(all.size(), [&](IndexRange range) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                all[i] = valueAt(pairAt(axes_.pointAt(Corner(i, count_).shifted(0))));
                if (storage == TableStorage::Float) continue;
                for (float& value : all[i]) value = toFloat(toHalf(value));
            }
        });
        return all;
    }

    /// Relative, of the worst band in the middle of each cell: the interpolated value there is the
    /// mean of the eight corners. Of bands whose f is not 0; NaN where there is none to compare.
    [[nodiscard]] std::vector<float> errors(const std::vector<Stored>& values) const {
        const BoxResolution cells = cellCount();
        std::vector<float> all(cells.nodes());
        parallelFor(all.size(), [&](IndexRange range) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                all[i] = errorOf(Corner(i, cells), values);
            }
        });
        return all;
    }

    /// Root mean square of the errors of the cells that meet at a node; `unknown` where none is
    /// known.
    [[nodiscard]] float errorAtNode(std::size_t node,
                                    const std::vector<float>& errors,
                                    float unknown) const {
        const BoxResolution cells = cellCount();
        const Corner at(node, count_);
        double squares = 0;
        int known = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const int i = at.tanHalf - corner / 4;
            const int j = at.cosDiff - corner / 2 % 2;
            const int k = at.skew - corner % 2;
            const bool inside = i >= 0 && j >= 0 && k >= 0 && i < cells.tanHalf &&
                                j < cells.cosDiff && k < cells.skew;
            if (!inside) continue;
            const float error = errors[numberOf(cells, i, j, k)];
            if (std::isnan(error)) continue;
            squares += error * error;
            ++known;
        }
        return known == 0 ? unknown : static_cast<float>(std::sqrt(squares / known));
    }

private:
    [[nodiscard]] BoxResolution cellCount() const {
        return {count_.tanHalf - 1, count_.cosDiff - 1, count_.skew - 1};
    }

    [[nodiscard]] Stored valueAt(const LightView& pair) const {
        const LedBands f = truth_.answer(pair).f;
        const LedBands carried = carrier_ != nullptr ? carrier_->answer(pair).f : LedBands::all(1);
        Stored stored{kNan, kNan, kNan};
        for (std::size_t band = 0; band < 3; ++band) {
            if (!std::isfinite(f.value[band]) || !(carried.value[band] > 0)) continue;
            if (carrier_ != nullptr) {
                const double ratio = f.value[band] / carried.value[band];
                if (std::abs(ratio) < kLargestHalf) stored[band] = static_cast<float>(ratio);
            } else {
                stored[band] = static_cast<float>(
                    f.value[band] > 0 ? std::max(kLeastLog2, std::log2(f.value[band]))
                                      : kLeastLog2);
            }
        }
        return stored;
    }

    [[nodiscard]] float errorOf(const Corner& cell, const std::vector<Stored>& values) const {
        const LightView pair = pairAt(axes_.pointAt(cell.shifted(0.5)));
        const LedBands truth = truth_.answer(pair).f;
        const LedBands carried = carrier_ != nullptr ? carrier_->answer(pair).f : LedBands::all(1);
        double worst = kNan;
        for (std::size_t band = 0; band < 3; ++band) {
            if (truth.value[band] == 0) continue;
            double mean = 0;
            for (int corner = 0; corner < 8; ++corner) {
                mean += values[numberOf(count_,
                                        cell.tanHalf + corner / 4,
                                        cell.cosDiff + corner / 2 % 2,
                                        cell.skew + corner % 2)][band] /
                        8.0;
            }
            const double f = carrier_ != nullptr ? mean * carried.value[band] : std::exp2(mean);
            worst = std::fmax(worst, std::abs(f / truth.value[band] - 1));
        }
        return std::isfinite(worst) ? static_cast<float>(worst) : kNan;
    }

    const Scatterer& truth_;
    const AnalyticModel* carrier_;
    const BoxAxes& axes_;
    BoxResolution count_;
};

template <class Number>
Number numberFrom(float value) {
    if constexpr (std::is_same_v<Number, Half16>) {
        return toHalf(value);
    } else {
        return value;
    }
}

template <class Number>
std::vector<BakedNode<Number>> nodesOf(const Baking& baking,
                                       const std::vector<Stored>& values,
                                       const std::vector<float>& errors,
                                       const BakeReport& report) {
    // What is not known is taken as the worst, and what a half cannot hold as the most it can.
    const auto worst = static_cast<float>(report.worstError);
    const auto errorAt = [&](std::size_t node) {
        const float error = baking.errorAtNode(node, errors, worst) / kErrorUnit;
        return std::min(error, static_cast<float>(kLargestHalf));
    };
    std::vector<BakedNode<Number>> nodes;
    nodes.reserve(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        nodes.push_back({numberFrom<Number>(values[i][0]),
                         numberFrom<Number>(values[i][1]),
                         numberFrom<Number>(values[i][2]),
                         numberFrom<Number>(errorAt(i))});
    }
    return nodes;
}

/// Largest relative difference of the mean of the bands when a few pairs are turned or swapped.
double asymmetryOf(const Scatterer& truth) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit;
    const auto drawn = [&] {
        const double s2 = unit(random) * 0.98;  // to 82 degrees
        return Direction::fromSpherical(Radians(std::asin(std::sqrt(s2))),
                                        Radians(2 * kPi * unit(random)));
    };
    const auto meanAt = [&](const LightView& pair) {
        const LedBands f = truth.answer(pair).f;
        return (f.value[0] + f.value[1] + f.value[2]) / 3;
    };
    constexpr int kPairs = 200;
    double worst = 0;
    for (int i = 0; i < kPairs; ++i) {
        const LightView pair{drawn(), drawn()};
        const Radians turn(2 * kPi * unit(random));
        const double f = meanAt(pair);
        for (const double other : {meanAt({pair.in.turned(turn), pair.out.turned(turn)}),
                                   meanAt({.in = pair.out, .out = pair.in})}) {
            worst = std::fmax(worst, std::abs(other / f - 1));
        }
    }
    return worst;
}

BakeReport reportOf(const Scatterer& truth,
                    const std::vector<Stored>& values,
                    const std::vector<float>& errors,
                    bool logarithms) {
    BakeReport report;
    for (const Stored& value : values) {
        const bool answered =
            !std::isnan(value[0]) && !std::isnan(value[1]) && !std::isnan(value[2]);
        if (!answered) ++report.unanswered;
        const float least = std::min({value[0], value[1], value[2]});
        if (logarithms && least <= static_cast<float>(kLeastLog2)) ++report.notHeld;
    }
    for (const float error : errors) {
        if (!std::isnan(error)) {
            report.worstError = std::max(report.worstError, static_cast<double>(error));
        }
    }
    report.asymmetry = asymmetryOf(truth);
    return report;
}

}  // namespace

double halfWidthTangent(const Scatterer& of) {
    constexpr double kFirst = 1e-6, kLast = 10, kStep = 1.1;
    std::vector<double> at, f;
    for (double tangent = kFirst; tangent < kLast; tangent *= kStep) {
        const Answer answer = of.answer(pairAt({tangent, std::cos(kPi / 6), 0}));
        const double mean = (answer.f.value[0] + answer.f.value[1] + answer.f.value[2]) / 3;
        if (!std::isfinite(mean)) continue;
        at.push_back(tangent);
        f.push_back(mean);
    }
    if (f.empty()) return 1;
    const double floor = *std::min_element(f.begin(), f.end());
    if (!(f.front() > 1.5 * floor)) return 1;
    const auto half = std::find_if(
        f.begin(), f.end(), [&](double value) { return value <= (f.front() + floor) / 2; });
    return at[static_cast<std::size_t>(half - f.begin())];
}

Result<BakedTable> bakeTable(const Scatterer& truth,
                             std::unique_ptr<const AnalyticModel> carrier,
                             const BakeOptions& options) {
    for (const int nodes :
         {options.resolution.tanHalf, options.resolution.cosDiff, options.resolution.skew}) {
        if (nodes >= 2 && nodes <= 512) continue;
        return Error{ErrorKind::Usage,
                     "bake: " + std::to_string(nodes) + " nodes along an axis: wanted 2 to 512"};
    }
    const double t0 = options.t0 > 0 ? options.t0 : 0.75 * halfWidthTangent(truth);
    const BoxAxes axes(options.resolution, t0);
    const Baking baking(truth, carrier.get(), axes);
    const std::vector<Stored> values = baking.values(options.storage);
    const std::vector<float> errors = baking.errors(values);
    const BakeReport report = reportOf(truth, values, errors, carrier == nullptr);
    BakedNodes nodes;
    if (options.storage == TableStorage::Half) {
        nodes = nodesOf<Half16>(baking, values, errors, report);
    } else {
        nodes = nodesOf<float>(baking, values, errors, report);
    }
    return BakedTable(axes, std::move(nodes), std::move(carrier), report);
}

}  // namespace gonio::proc
