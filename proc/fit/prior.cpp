#include "proc/fit/prior.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/core/coordinates.h"
#include "proc/core/parallel.h"
#include "proc/models/spec.h"

namespace gonio::proc {
namespace {

using Index = Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Models = std::vector<std::shared_ptr<const AnalyticModel>>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The grid: theta_h in squares, so that narrow lobes have points; theta_d and phi_d even. phi_d to
/// 90 degrees: materials of the library are reciprocal and symmetric to the plane of incidence.
constexpr std::size_t kHalf = 24;
constexpr std::size_t kDifference = 12;
constexpr std::size_t kAzimuth = 8;

struct GridPlace {
    std::size_t half, difference, azimuth;
};

std::size_t indexOf(const GridPlace& at) {
    return (at.half * kDifference + at.difference) * kAzimuth + at.azimuth;
}

/// A place's pair of directions.
LightView pairAt(const GridPlace& at) {
    const double h = (static_cast<double>(at.half) + 0.5) / kHalf;
    const double d = (static_cast<double>(at.difference) + 0.5) / kDifference;
    const double a = (static_cast<double>(at.azimuth) + 0.5) / kAzimuth;
    return fromHalfDifference({.thetaHalf = Radians(h * h * kPi / 2),
                               .phiHalf = Radians(0),
                               .thetaDiff = Radians(d * kPi / 2),
                               .phiDiff = Radians(a * kPi / 2)});
}

/// The place nearest to a pair.
GridPlace placeOf(const Pair<double>& pair) {
    const Half<double> half(pair);
    const double h = std::sqrt(std::acos(half.cosTheta()) * 2 / kPi);
    const double d = std::acos(half.cosDiff) * 2 / kPi;
    // The difference's azimuth about h: tangent by the components across and along.
    const double across = half.h.x * pair.in.y - half.h.y * pair.in.x;
    const double length = std::sqrt(half.length2);
    const double along = (pair.in.z * half.length2 - half.h.z * (half.length2 / 2)) / length;
    const double a = std::atan2(std::abs(across), std::abs(along)) * 2 / kPi;
    const auto bin = [](double x, std::size_t n) {
        return std::min(n - 1, static_cast<std::size_t>(std::max(0.0, x * static_cast<double>(n))));
    };
    return {bin(h, kHalf), bin(d, kDifference), bin(a, kAzimuth)};
}

double logOf(double f, double cosines) {
    return std::log(std::max(f, 0.0) * cosines + kPriorFloor);
}

/// Pairs as arrays of components.
struct PairColumns {
    std::vector<double> inX, inY, inZ, outX, outY, outZ;

    void add(const Pair<double>& pair) {
        inX.push_back(pair.in.x);
        inY.push_back(pair.in.y);
        inZ.push_back(pair.in.z);
        outX.push_back(pair.out.x);
        outY.push_back(pair.out.y);
        outZ.push_back(pair.out.z);
    }
    [[nodiscard]] std::size_t size() const { return inX.size(); }
    /// Of a model in one band.
    [[nodiscard]] std::vector<double> f(const AnalyticModel& model) const {
        std::vector<double> r(size());
        std::vector<double> g(size());
        std::vector<double> b(size());
        model.evaluate(PairArrays<double>{inX, inY, inZ, outX, outY, outZ},
                       BandArrays<double>{r, g, b});
        return r;
    }
};

/// Grid points above the horizon.
struct GridPoints {
    std::vector<std::size_t> place;
    PairColumns pairs;

    GridPoints() {
        const double lowest = std::cos(89.5 * kPi / 180);
        for (std::size_t h = 0; h < kHalf; ++h) {
            for (std::size_t d = 0; d < kDifference; ++d) {
                for (std::size_t a = 0; a < kAzimuth; ++a) {
                    const LightView pair = pairAt({h, d, a});
                    if (pair.in.z() < lowest || pair.out.z() < lowest) continue;
                    place.push_back(indexOf({h, d, a}));
                    pairs.add(pairOf<double>(pair));
                }
            }
        }
    }
    [[nodiscard]] std::size_t size() const { return place.size(); }
};

Result<Models> modelsOf(const PriorLibrary& library) {
    Models models;
    for (const std::string& spec : library.specs) {
        auto model = makeModel(spec);
        if (!model) return model.error().in("prior library");
        models.push_back(std::move(*model));
    }
    return models;
}

/// y of every material (column) at every grid point (row).
MatrixXd gridOf(const Models& models, const GridPoints& points) {
    MatrixXd y(static_cast<Index>(points.size()), static_cast<Index>(models.size()));
    parallelFor(models.size(), [&](IndexRange range) {
        for (std::size_t m = range.begin; m < range.end; ++m) {
            const std::vector<double> f = points.pairs.f(*models[m]);
            for (std::size_t i = 0; i < f.size(); ++i) {
                y(static_cast<Index>(i), static_cast<Index>(m)) =
                    logOf(f[i], points.pairs.inZ[i] * points.pairs.outZ[i]);
            }
        }
    });
    return y;
}

/// Orthonormal functions from picked columns, with what they leave of each column.
struct Picked {
    std::vector<Index> columns;
    MatrixXd coefficients;  ///< of every column, one row per function
    MatrixXd rest;          ///< points x columns
};

Picked pick(MatrixXd rest, std::size_t functions) {
    const Index count = std::min<Index>(static_cast<Index>(functions), rest.cols());
    Picked picked;
    picked.coefficients = MatrixXd::Zero(count, rest.cols());
    VectorXd left = rest.colwise().squaredNorm();
    const double smallest = 1e-12 * left.maxCoeff();
    for (Index k = 0; k < count; ++k) {
        Index worst = 0;
        if (left.maxCoeff(&worst) <= smallest) break;
        const VectorXd direction = rest.col(worst).normalized();
        picked.columns.push_back(worst);
        parallelFor(static_cast<std::size_t>(rest.cols()), [&](IndexRange range) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const auto c = static_cast<Index>(i);
                const double along = direction.dot(rest.col(c));
                picked.coefficients(k, c) = along;
                rest.col(c) -= along * direction;
                left(c) = rest.col(c).squaredNorm();
            }
        });
        left(worst) = 0;
    }
    picked.coefficients.conservativeResize(static_cast<Index>(picked.columns.size()), rest.cols());
    picked.rest = std::move(rest);
    return picked;
}

}  // namespace

Result<PriorBasis> PriorBasis::over(const PriorLibrary& library, std::size_t functions) {
    const Result<Models> models = modelsOf(library);
    if (!models) return models.error();
    const GridPoints points;
    const Picked picked = pick(gridOf(*models, points), functions);
    PriorBasis basis;
    const auto count = static_cast<Index>(picked.columns.size());
    basis.triangle_ = MatrixXd::Zero(count, count);
    for (Index k = 0; k < count; ++k) {
        const Index column = picked.columns[static_cast<std::size_t>(k)];
        basis.picked_.push_back((*models)[static_cast<std::size_t>(column)]);
        basis.triangle_.col(k).head(k + 1) = picked.coefficients.col(column).head(k + 1);
    }
    const auto materials = static_cast<double>(models->size());
    basis.mean_ = picked.coefficients.rowwise().mean();
    const MatrixXd centred = picked.coefficients.colwise() - basis.mean_;
    basis.covariance_ = centred * centred.transpose() / std::max(1.0, materials - 1);
    basis.rest_.assign(kHalf * kDifference * kAzimuth, kNan);
    for (std::size_t i = 0; i < points.size(); ++i) {
        basis.rest_[points.place[i]] =
            picked.rest.row(static_cast<Index>(i)).squaredNorm() / materials;
    }
    return basis;
}

MatrixXd PriorBasis::at(const BrdfData& data) const {
    PairColumns pairs;
    for (const WeightedNode& node : data.nodes) pairs.add(node.pair);
    MatrixXd y(static_cast<Index>(picked_.size()), static_cast<Index>(data.rows.size()));
    parallelFor(picked_.size(), [&](IndexRange range) {
        for (std::size_t k = range.begin; k < range.end; ++k) {
            const std::vector<double> nodes = pairs.f(*picked_[k]);
            for (std::size_t i = 0; i < data.rows.size(); ++i) {
                const FitRow& row = data.rows[i];
                double f = 0;
                for (std::size_t n = 0; n < row.nodeCount; ++n) {
                    f += data.nodes[row.firstNode + n].weight * nodes[row.firstNode + n];
                }
                y(static_cast<Index>(k), static_cast<Index>(i)) =
                    logOf(f, cos(data.incidences[row.group]) * row.cosThetaO);
            }
        }
    });
    triangle_.transpose().triangularView<Eigen::Lower>().solveInPlace(y);
    return y;
}

VectorXd PriorBasis::at(const LightView& pair) const {
    VectorXd y(static_cast<Index>(picked_.size()));
    for (std::size_t k = 0; k < picked_.size(); ++k) {
        y(static_cast<Index>(k)) =
            logOf(picked_[k]->answer(pair).f[Band::R], pair.in.z() * pair.out.z());
    }
    triangle_.transpose().triangularView<Eigen::Lower>().solveInPlace(y);
    return y;
}

double PriorBasis::restVariance(const Pair<double>& pair) const {
    const GridPlace at = placeOf(pair);
    const double here = rest_[indexOf(at)];
    if (!std::isnan(here)) return here;
    // At the horizon: the largest nearby.
    double most = 0;
    for (std::size_t h = at.half - std::min<std::size_t>(at.half, 2); h <= at.half; ++h) {
        for (std::size_t d = at.difference - std::min<std::size_t>(at.difference, 1);
             d <= at.difference;
             ++d) {
            for (std::size_t a = 0; a < kAzimuth; ++a) {
                const double rest = rest_[indexOf({h, d, a})];
                if (!std::isnan(rest)) most = std::max(most, rest);
            }
        }
    }
    return most;
}

PriorPosterior::Value PriorPosterior::at(const VectorXd& functions, double restVariance) const {
    const double variance =
        (inverseFactor_.triangularView<Eigen::Lower>() * functions).squaredNorm() + restVariance;
    return {.y = mean_.dot(functions), .deviation = std::sqrt(variance)};
}

PriorEvidence::PriorEvidence(const PriorBasis& basis,
                             const BrdfData& data,
                             const MatrixXd& functions,
                             std::size_t band)
    : basis_(&basis), groups_(data.incidences.size()) {
    constexpr double kLargestRelative = 0.3;
    const auto k = static_cast<Index>(basis.size());
    MatrixXd prior = basis.covariance();
    prior.diagonal().array() += 1e-10 * prior.diagonal().maxCoeff() + 1e-12;  // materials all alike
    priorPrecision_ = prior.llt().solve(MatrixXd::Identity(k, k));
    std::vector<Index> counts(groups_.size(), 0);
    for (const FitRow& row : data.rows) ++counts[row.group];
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        groups_[g].functions.resize(k, counts[g]);
        groups_[g].y.resize(counts[g]);
        counts[g] = 0;
    }
    for (std::size_t i = 0; i < data.rows.size(); ++i) {
        const FitRow& row = data.rows[i];
        if (std::isnan(row.f[band])) continue;
        const double cosines = cos(data.incidences[row.group]) * row.cosThetaO;
        const double value = std::max(row.f[band], 0.0) * cosines + kPriorFloor;
        const double relative = data.uOf(row, band) * cosines / value;
        if (relative > kLargestRelative) continue;
        const double rest = basis.restVariance(data.nodesOf(row).front().pair);
        const double weight = 1 / std::sqrt(relative * relative + rest);
        const Index at = counts[row.group]++;
        groups_[row.group].functions.col(at) = functions.col(static_cast<Index>(i)) * weight;
        groups_[row.group].y(at) = std::log(value) * weight;
    }
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        Group& group = groups_[g];
        group.functions.conservativeResize(k, counts[g]);
        group.y.conservativeResize(counts[g]);
        group.precision = MatrixXd::Zero(k, k);
        group.pull = VectorXd::Zero(k);
        if (counts[g] == 0) continue;
        group.precision.selfadjointView<Eigen::Lower>().rankUpdate(group.functions);
        group.pull = group.functions * group.y;
    }
}

bool PriorEvidence::empty() const {
    return std::all_of(
        groups_.begin(), groups_.end(), [](const Group& group) { return group.y.size() == 0; });
}

PriorPosterior PriorEvidence::posterior(std::optional<std::size_t> without) const {
    MatrixXd precision = priorPrecision_;
    VectorXd pull = priorPrecision_ * basis_->mean();
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        if (g == without) continue;
        precision.triangularView<Eigen::Lower>() += groups_[g].precision;
        pull += groups_[g].pull;
    }
    const Eigen::LLT<MatrixXd> factor(precision.selfadjointView<Eigen::Lower>());
    const auto k = static_cast<Index>(basis_->size());
    return {factor.solve(pull), factor.matrixL().solve(MatrixXd::Identity(k, k))};
}

double PriorEvidence::chiSquare(const PriorPosterior& posterior) const {
    double sum = 0;
    double freedom = 0;
    for (const Group& group : groups_) {
        if (group.y.size() == 0) continue;
        sum += (group.y - group.functions.transpose() * posterior.mean()).squaredNorm();
        // Less the effective parameters: the trace of the hat matrix.
        freedom += static_cast<double>(group.y.size()) -
                   (posterior.inverseFactor() * group.functions).squaredNorm();
    }
    return sum / std::max(1.0, freedom);
}

double PriorEvidence::predictedChiSquare(const PriorPosterior& without, std::size_t group) const {
    const Group& left = groups_[group];
    if (left.y.size() == 0) return 0;
    const VectorXd off = left.y - left.functions.transpose() * without.mean();
    const VectorXd variance =
        (without.inverseFactor() * left.functions).colwise().squaredNorm().array() + 1;
    return off.array().square().cwiseQuotient(variance.array()).mean();
}

bool PriorGate::passes() const {
    if (!(chiSquare <= kMost)) return false;  // nor NaN
    for (std::size_t g = 0; g < predicted.size(); ++g) {
        const bool end = g == 0 || g + 1 == predicted.size();
        if (!(predicted[g] <= (end ? kMostPredictedAtEnd : kMostPredicted))) return false;
    }
    return true;
}

PriorGate priorGate(const PriorEvidence& evidence, std::size_t incidences) {
    PriorGate gate{.chiSquare = evidence.chiSquare(evidence.posterior()), .predicted = {}};
    for (std::size_t g = 0; g < incidences && incidences > 1; ++g) {
        gate.predicted.push_back(evidence.predictedChiSquare(evidence.posterior(g), g));
    }
    return gate;
}

}  // namespace gonio::proc
