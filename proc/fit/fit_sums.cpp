#include "proc/fit/fit_sums.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gonio::proc {
namespace {

using Index = Eigen::Index;

constexpr Index at(std::size_t i) { return static_cast<Index>(i); }

/// Sums over the values of one band, by its shared and its own parameters.
struct BandSums {
    double cost = 0;
    std::array<double, kMostLocal> gradient{};
    std::array<std::array<double, kMostLocal>, kMostLocal> matrix{};

    void add(const std::array<double, kMostLocal>& j,
             double residual,
             double weight,
             std::size_t n) {
        for (std::size_t i = 0; i < n; ++i) {
            const double wj = weight * j[i];
            gradient[i] += wj * residual;
            for (std::size_t k = i; k < n; ++k) matrix[i][k] += wj * j[k];
        }
    }
};

}  // namespace

FitSums::FitSums(const Family& family, const BrdfData& data, const ModelFitOptions& options)
    : family_(&family),
      data_(&data),
      options_(options),
      shared_(family.sharedCount()),
      perBand_(family.perBandCount()),
      bands_(data.bandsUsed()),
      count_(family.parameterCount(bands_)) {
    for (std::size_t b = 0; b < bands_; ++b) {
        double sum = 0;
        double count = 0;
        for (const FitRow& row : data.rows) {
            if (!std::isfinite(row.f[b])) continue;
            sum += row.f[b] * row.f[b];
            count += 1;
        }
        if (sum > 0) size_[b] = std::sqrt(sum / count);
    }
}

const FamilyParameter& FitSums::parameter(std::size_t place) const {
    const auto& all = family_->parameters();
    return place < shared_ ? all[place] : all[shared_ + (place - shared_) / bands_];
}

std::vector<double> FitSums::lower() const {
    std::vector<double> q;
    for (std::size_t i = 0; i < count_; ++i) {
        const FamilyParameter& p = parameter(i);
        q.push_back(p.scale == ParameterScale::Log ? std::log(p.lower) : p.lower);
    }
    return q;
}

std::vector<double> FitSums::upper() const {
    std::vector<double> q;
    for (std::size_t i = 0; i < count_; ++i) {
        const FamilyParameter& p = parameter(i);
        q.push_back(p.scale == ParameterScale::Log ? std::log(p.upper) : p.upper);
    }
    return q;
}

double FitSums::toValue(std::size_t place, double q) const {
    const FamilyParameter& p = parameter(place);
    // A bound's logarithm need not come back as the bound.
    const double value = p.scale == ParameterScale::Log ? std::exp(q) : q;
    return std::clamp(value, p.lower, p.upper);
}

double FitSums::slope(std::size_t place, double q) const {
    return parameter(place).scale == ParameterScale::Log ? std::exp(q) : 1;
}

FamilyPoint FitSums::point(std::span<const double> q) const {
    FamilyPoint point;
    for (std::size_t i = 0; i < shared_; ++i) point.shared.push_back(toValue(i, q[i]));
    for (std::size_t k = 0; k < perBand_; ++k) {
        LedBands bands = LedBands::all(toValue(place(k, 0), q[place(k, 0)]));
        for (std::size_t b = 1; b < bands_; ++b) {
            bands.value[b] = toValue(place(k, b), q[place(k, b)]);
        }
        point.perBand.push_back(bands);
    }
    return point;
}

FitSums::Weight FitSums::robust(double s) const {
    const double scale2 = options_.lossScale * options_.lossScale;
    switch (options_.loss) {
        case RobustLoss::None: break;
        case RobustLoss::Huber:
            if (s <= scale2) break;
            return {2 * options_.lossScale * std::sqrt(s) - scale2,
                    options_.lossScale / std::sqrt(s)};
        case RobustLoss::Cauchy: return {scale2 * std::log1p(s / scale2), 1 / (1 + s / scale2)};
    }
    return {s, 1};
}

double FitSums::scaleOf(const FitRow& row, std::size_t band) const {
    const double u = options_.weights.uncertainty ? row.uRandom[band] : size_[band];
    return options_.weights.cosine ? u / std::sqrt(row.cosThetaO) : u;
}

template <class Visit>
void FitSums::eachValue(const FamilyPoint& point,
                        std::span<const std::uint32_t> rows,
                        Visit&& visit) const {
    for (const std::uint32_t i : rows) {
        const FitRow& row = data_->rows[i];
        const std::span nodes(data_->nodes.data() + row.firstNode, row.nodeCount);
        const std::array<BandSlopes, 3> slopes = family_->slopes(point, nodes);
        for (std::size_t b = 0; b < bands_; ++b) {
            if (!std::isfinite(row.f[b])) continue;
            visit(row, b, slopes[b], scaleOf(row, b));
        }
    }
}

std::size_t FitSums::residualCount(std::span<const std::uint32_t> rows) const {
    std::size_t count = 0;
    for (const std::uint32_t i : rows) {
        for (std::size_t b = 0; b < bands_; ++b) {
            count += std::isfinite(data_->rows[i].f[b]) ? 1U : 0U;
        }
    }
    return count;
}

std::optional<NormalSums> FitSums::sums(std::span<const double> q,
                                        std::span<const std::uint32_t> rows,
                                        Wanted wanted) const {
    const FamilyPoint p = point(q);
    NormalSums total = NormalSums::zero(count_);
    std::vector<std::array<Shared, 3>> shared(data_->incidences.size());
    if (wanted == Wanted::Cost) {
        for (const std::uint32_t i : rows) {
            const FitRow& row = data_->rows[i];
            const LedBands f =
                family_->f(p, std::span(data_->nodes.data() + row.firstNode, row.nodeCount));
            for (std::size_t b = 0; b < bands_; ++b) {
                if (!std::isfinite(row.f[b])) continue;
                const double scale = scaleOf(row, b);
                const double r = (f.value[b] - row.f[b]) / scale;
                const Weight weight = robust(r * r);
                total.cost += weight.loss;
                const double s = byCovariance() ? stateOf(row, b) / scale : 0;
                shared[row.group][b].rs += weight.factor * r * s;
                shared[row.group][b].ss += weight.factor * s * s;
            }
        }
        for (const auto& group : shared) {
            for (const Shared& one : group) total.cost -= one.rs * one.rs / (1 + one.ss);
        }
        return std::isfinite(total.cost) ? std::optional(total) : std::nullopt;
    }
    const std::size_t local = shared_ + perBand_;
    std::array<BandSums, 3> bands;
    eachValue(p, rows, [&](const FitRow& row, std::size_t b, const BandSlopes& f, double scale) {
        const double r = (f.value - row.f[b]) / scale;
        const Weight weight = robust(r * r);
        bands[b].cost += weight.loss;
        std::array<double, kMostLocal> j;
        for (std::size_t i = 0; i < local; ++i) j[i] = f.slope[i] / scale;
        bands[b].add(j, r, weight.factor, local);
        const double s = byCovariance() ? stateOf(row, b) / scale : 0;
        if (s == 0) return;
        Shared& one = shared[row.group][b];
        one.rs += weight.factor * r * s;
        one.ss += weight.factor * s * s;
        for (std::size_t i = 0; i < local; ++i) one.js[i] += weight.factor * j[i] * s;
    });
    for (const auto& group : shared) {
        for (std::size_t b = 0; b < bands_; ++b) {
            const Shared& one = group[b];
            bands[b].cost -= one.rs * one.rs / (1 + one.ss);
            bands[b].add(one.js, one.rs, -1 / (1 + one.ss), local);
        }
    }
    for (std::size_t b = 0; b < bands_; ++b) {
        const auto global = [&](std::size_t i) {
            return at(i < shared_ ? i : place(i - shared_, b));
        };
        std::array<double, kMostLocal> chain;
        for (std::size_t i = 0; i < local; ++i) {
            const auto where = static_cast<std::size_t>(global(i));
            chain[i] = slope(where, q[where]);
        }
        total.cost += bands[b].cost;
        for (std::size_t i = 0; i < local; ++i) {
            total.gradient(global(i)) += chain[i] * bands[b].gradient[i];
            for (std::size_t k = i; k < local; ++k) {
                const double value = chain[i] * chain[k] * bands[b].matrix[i][k];
                total.matrix(global(i), global(k)) += value;
                if (k != i) total.matrix(global(k), global(i)) += value;
            }
        }
    }
    return total.finite() ? std::optional(total) : std::nullopt;
}

void FitSums::shareErrors(const FamilyPoint& point) {
    state_.clear();
    std::vector<std::array<double, 3>> all(data_->rows.size());
    bool any = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const FitRow& row = data_->rows[i];
        const LedBands f =
            family_->f(point, std::span(data_->nodes.data() + row.firstNode, row.nodeCount));
        for (std::size_t b = 0; b < bands_; ++b) {
            all[i][b] = row.uState[b] * f.value[b];
            any = any || all[i][b] != 0;
        }
    }
    if (any) state_ = std::move(all);
}

double FitSums::chiSquare(const FamilyPoint& point, std::span<const std::uint32_t> rows) const {
    std::vector<std::array<Shared, 3>> shared(data_->incidences.size());
    double sum = 0;
    for (const std::uint32_t i : rows) {
        const FitRow& row = data_->rows[i];
        const LedBands f =
            family_->f(point, std::span(data_->nodes.data() + row.firstNode, row.nodeCount));
        for (std::size_t b = 0; b < bands_; ++b) {
            if (!std::isfinite(row.f[b])) continue;
            const double r = (f.value[b] - row.f[b]) / row.uRandom[b];
            const double s = stateOf(row, b) / row.uRandom[b];
            sum += r * r;
            shared[row.group][b].rs += r * s;
            shared[row.group][b].ss += s * s;
        }
    }
    for (const auto& group : shared) {
        for (const Shared& one : group) sum -= one.rs * one.rs / (1 + one.ss);
    }
    return sum;
}

FitSums::Spread FitSums::spread(std::span<const double> q,
                                std::span<const std::uint32_t> rows) const {
    Spread all{.squared = Eigen::MatrixXd::Zero(at(count_), at(count_)),
               .plain = Eigen::MatrixXd::Zero(at(count_), at(count_)),
               .systematic = Eigen::MatrixXd::Zero(at(count_), at(bands_))};
    const std::size_t local = shared_ + perBand_;
    Eigen::VectorXd j(at(local));
    std::vector<Eigen::Index> global(local);
    std::vector<std::array<Eigen::VectorXd, 3>> shared(data_->incidences.size());
    for (auto& group : shared) group.fill(Eigen::VectorXd::Zero(at(count_)));
    eachValue(
        point(q), rows, [&](const FitRow& row, std::size_t b, const BandSlopes& f, double scale) {
            const double r = (f.value - row.f[b]) / scale;
            const double weight = robust(r * r).factor;
            for (std::size_t i = 0; i < local; ++i) {
                const std::size_t where = i < shared_ ? i : place(i - shared_, b);
                global[i] = at(where);
                j(at(i)) = weight * slope(where, q[where]) * f.slope[i] / scale;
            }
            const double noise = row.uRandom[b] / scale;
            const double shift = row.uSystematic[b] / scale;
            const double state = stateOf(row, b) / scale;
            for (std::size_t i = 0; i < local; ++i) {
                all.systematic(global[i], at(b)) += j(at(i)) * shift;
                shared[row.group][b](global[i]) += j(at(i)) * state;
                for (std::size_t k = 0; k < local; ++k) {
                    all.plain(global[i], global[k]) += j(at(i)) * j(at(k));
                    all.squared(global[i], global[k]) += j(at(i)) * j(at(k)) * noise * noise;
                }
            }
        });
    for (std::size_t g = 0; g < shared.size(); ++g) {
        for (std::size_t b = 0; b < bands_; ++b) {
            const Eigen::VectorXd& js = shared[g][b];
            all.squared += js * js.transpose();
        }
    }
    return all;
}

double FitSums::solvePerBand(std::vector<double>& q, std::span<const std::uint32_t> rows) const {
    const auto sums = this->sums(q, rows, Wanted::Derivatives);
    if (!sums) return std::numeric_limits<double>::quiet_NaN();
    double cost = sums->cost;
    for (std::size_t b = 0; b < bands_; ++b) {
        // Coordinate descent: few, and convex.
        std::vector<double> step(perBand_, 0);
        const auto slopeAt = [&](std::size_t k) {
            double slope = sums->gradient(at(place(k, b)));
            for (std::size_t l = 0; l < perBand_; ++l) {
                slope += sums->matrix(at(place(k, b)), at(place(l, b))) * step[l];
            }
            return slope;
        };
        constexpr int kSweeps = 60;
        for (int sweep = 0; sweep < kSweeps; ++sweep) {
            for (std::size_t k = 0; k < perBand_; ++k) {
                const std::size_t i = place(k, b);
                const double curve = sums->matrix(at(i), at(i));
                if (!(curve > 0)) continue;
                const FamilyParameter& p = parameter(i);
                step[k] = std::clamp(step[k] - slopeAt(k) / curve, p.lower - q[i], p.upper - q[i]);
            }
        }
        for (std::size_t k = 0; k < perBand_; ++k) {
            cost += step[k] * (slopeAt(k) + sums->gradient(at(place(k, b))));
            q[place(k, b)] += step[k];
        }
    }
    return cost;
}

}  // namespace gonio::proc
