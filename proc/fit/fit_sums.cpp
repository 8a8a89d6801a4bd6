#include "proc/fit/fit_sums.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gonio::proc {
namespace {

using Index = Eigen::Index;

constexpr Index at(std::size_t i) { return static_cast<Index>(i); }

}  // namespace

void BandSums::add(const std::array<double, kMostLocal>& j,
                   double residual,
                   double weight,
                   std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
        const double wj = weight * j[i];
        gradient[i] += wj * residual;
        for (std::size_t k = i; k < n; ++k) matrix[i][k] += wj * j[k];
    }
}

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
        // A band of zeros was measured, too.
        if (count > 0) size_[b] = sum > 0 ? std::sqrt(sum / count) : 1;
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
        const double most = isHeld(i) ? p.lower : p.upper;
        q.push_back(p.scale == ParameterScale::Log ? std::log(most) : most);
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

std::vector<double> FitSums::numbersOf(const FamilyPoint& point) const {
    std::vector<double> q(count());
    const auto number = [&](std::size_t place, double value) {
        const FamilyParameter& p = parameter(place);
        const double inside = std::clamp(value, p.lower, p.upper);
        q[place] = p.scale == ParameterScale::Log ? std::log(inside) : inside;
    };
    for (std::size_t i = 0; i < shared_; ++i) number(i, point.shared[i]);
    for (std::size_t k = 0; k < perBand_; ++k) {
        for (std::size_t b = 0; b < bands_; ++b) number(place(k, b), point.perBand[k].value[b]);
    }
    return q;
}

FitSums::Loss FitSums::robust(double s) const {
    const double scale2 = options_.lossScale * options_.lossScale;
    switch (options_.loss) {
        case RobustLoss::None: break;
        case RobustLoss::Huber:
            if (s <= scale2) break;
            return {2 * options_.lossScale * std::sqrt(s) - scale2,
                    options_.lossScale / std::sqrt(s),
                    0};
        case RobustLoss::Cauchy: {
            const double x = s / scale2;
            return {scale2 * std::log1p(x), 1 / (1 + x), (1 - x) / ((1 + x) * (1 + x))};
        }
    }
    return {s, 1, 1};
}

double FitSums::weightOf(const FitRow& row, std::size_t band) const {
    const double relative = row.uRandom[band] / size_[band];
    return (options_.weights.uncertainty ? 1 : relative * relative) *
           (options_.weights.cosine ? row.cosThetaO : 1);
}

template <class Visit>
void FitSums::eachValue(const FamilyPoint& point,
                        std::span<const std::uint32_t> rows,
                        Visit&& visit) const {
    for (const std::uint32_t i : rows) {
        const FitRow& row = data_->rows[i];
        const std::array<BandSlopes, 3> slopes = family_->slopes(point, data_->nodesOf(row));
        for (std::size_t b = 0; b < bands_; ++b) {
            if (std::isfinite(row.f[b])) visit(i, b, slopes[b]);
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

double FitSums::cost(const FamilyPoint& point,
                     std::span<const std::uint32_t> rows,
                     bool asWeighted) const {
    double cost = 0;
    SharedSums along = sharedErrors(!asWeighted || byCovariance());
    for (const std::uint32_t i : rows) {
        const FitRow& row = data_->rows[i];
        const LedBands f = family_->f(point, data_->nodesOf(row));
        for (std::size_t b = 0; b < bands_; ++b) {
            if (!std::isfinite(row.f[b])) continue;
            const double r = (f.value[b] - row.f[b]) / row.uRandom[b];
            cost += asWeighted ? weightOf(row, b) * robust(r * r).value : r * r;
            along.add(row, b, r, sharedAbout(i, b) / row.uRandom[b]);
        }
    }
    return cost - along.taken();
}

/// By the parameters of all bands, as q.
void FitSums::addToAll(std::span<const double> q,
                       std::size_t band,
                       const BandSums& of,
                       NormalSums& total) const {
    const std::size_t local = shared_ + perBand_;
    std::array<Index, kMostLocal> global{};
    std::array<double, kMostLocal> chain{};
    for (std::size_t i = 0; i < local; ++i) {
        const std::size_t where = i < shared_ ? i : place(i - shared_, band);
        global[i] = at(where);
        chain[i] = slope(where, q[where]);
    }
    total.cost += of.cost;
    for (std::size_t i = 0; i < local; ++i) {
        total.gradient(global[i]) += chain[i] * of.gradient[i];
        for (std::size_t k = i; k < local; ++k) {
            const double value = chain[i] * chain[k] * of.matrix[i][k];
            total.matrix(global[i], global[k]) += value;
            if (k != i) total.matrix(global[k], global[i]) += value;
        }
    }
}

std::optional<NormalSums> FitSums::sums(std::span<const double> q,
                                        std::span<const std::uint32_t> rows,
                                        Wanted wanted) const {
    const FamilyPoint p = point(q);
    NormalSums total = NormalSums::zero(count_);
    if (wanted == Wanted::Cost) {
        total.cost = cost(p, rows, true);
        return std::isfinite(total.cost) ? std::optional(total) : std::nullopt;
    }
    const std::size_t local = shared_ + perBand_;
    std::array<BandSums, 3> bands;
    SharedSums along = sharedErrors(byCovariance());
    eachValue(p, rows, [&](std::uint32_t i, std::size_t b, const BandSlopes& f) {
        const FitRow& row = data_->rows[i];
        const double u = row.uRandom[b];
        const double r = (f.value - row.f[b]) / u;
        const double w = weightOf(row, b);
        const Loss loss = robust(r * r);
        bands[b].cost += w * loss.value;
        std::array<double, kMostLocal> j{};
        for (std::size_t k = 0; k < local; ++k) j[k] = f.slope[k] / u;
        bands[b].add(j, r, w * loss.slope, local);
        along.add(row, b, r, sharedAbout(i, b) / u, j, local);
    });
    along.eachTaken([&](std::size_t b, double factor, const AlongModel& one) {
        bands[b].cost -= factor * one.r * one.r;
        bands[b].add(one.j, one.r, -factor, local);
    });
    for (std::size_t b = 0; b < bands_; ++b) addToAll(q, b, bands[b], total);
    return total.finite() ? std::optional(total) : std::nullopt;
}

void FitSums::shareErrors(const FamilyPoint& point) {
    model_.clear();
    for (const FitRow& row : data_->rows) model_.push_back(family_->f(point, data_->nodesOf(row)));
}

double FitSums::chiSquare(const FamilyPoint& point, std::span<const std::uint32_t> rows) const {
    return cost(point, rows, false);
}

FitSums::Spread FitSums::spread(std::span<const double> q,
                                std::span<const std::uint32_t> rows) const {
    const Index n = at(count_);
    Spread all{.curvature = Eigen::MatrixXd::Zero(n, n),
               .noise = Eigen::MatrixXd::Zero(n, n),
               .systematic = Eigen::MatrixXd::Zero(n, at(bands_))};
    const std::size_t local = shared_ + perBand_;
    const auto global = [&](std::size_t i, std::size_t b) {
        return i < shared_ ? i : place(i - shared_, b);
    };
    const auto addTo = [&](Eigen::MatrixXd& matrix,
                           std::size_t b,
                           double factor,
                           const std::array<double, kMostLocal>& j) {
        for (std::size_t i = 0; i < local; ++i) {
            for (std::size_t k = 0; k < local; ++k) {
                matrix(at(global(i, b)), at(global(k, b))) += factor * j[i] * j[k];
            }
        }
    };
    SharedSums along = sharedErrors(true);
    eachValue(point(q), rows, [&](std::uint32_t i, std::size_t b, const BandSlopes& f) {
        const FitRow& row = data_->rows[i];
        const double u = row.uRandom[b];
        const double r = (f.value - row.f[b]) / u;
        const double w = weightOf(row, b);
        const Loss loss = robust(r * r);
        std::array<double, kMostLocal> j{};
        std::array<double, kMostLocal> moved{};
        for (std::size_t k = 0; k < local; ++k) {
            const std::size_t where = global(k, b);
            j[k] = slope(where, q[where]) * f.slope[k] / u;
            moved[k] = w * loss.bend * j[k];
            all.systematic(at(where), at(b)) += moved[k] * row.uSystematic[b] / u;
        }
        // A robust loss is for residuals that are not what u says: then by what they are.
        const double size2 = options_.loss == RobustLoss::None ? 1 : r * r;
        addTo(all.curvature, b, w * loss.bend, j);
        addTo(all.noise, b, w * loss.slope * w * loss.slope * size2, j);
        along.add(row, b, r, sharedAbout(i, b) / u, moved, local);
    });
    along.eachAdded([&](std::size_t b, double factor, const AlongModel& one) {
        addTo(all.noise, b, factor, one.j);
    });
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
