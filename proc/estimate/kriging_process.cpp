#include "proc/estimate/kriging_process.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "proc/estimate/incidence_frame.h"

namespace gonio::proc {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Index = Eigen::Index;
using Place = Eigen::Vector3d;

namespace {

/// Coordinates of a pair under a process: distances of such places are Euclidean.
Place placeOf(const KrigingProcess& process, const LightView& pair) {
    const LightView straight = isotropicPair(pair);
    const auto rho = [&](const Direction& w) {
        const double disc = std::sqrt(2.0) * std::sin(w.theta().value() / 2);
        return disc * (1 + process.grazing * std::pow(disc, 6));
    };
    const double in = rho(straight.in);
    const double out = rho(straight.out);
    const double phi = straight.out.phi().value();
    // The mirror direction lies at x = -in.
    const double x = out * std::cos(phi) + (process.fromMirror ? in : 0);
    return Place(std::sqrt(process.incidenceWeight) * in, x, std::abs(out * std::sin(phi))) /
           process.length;
}

double matern(double distance) {
    const double r = std::sqrt(5.0) * distance;
    return (1 + r + r * r / 3) * std::exp(-r);
}

}  // namespace

LightView isotropicPair(const LightView& pair) {
    constexpr Radians kNormal(1e-9);
    if (pair.in.theta() > kNormal) return withLightAtZero(pair);
    return {.in = Direction(), .out = Direction::fromSpherical(pair.out.theta(), Radians(0))};
}

double correlation(const KrigingPlace& a, const KrigingPlace& b) {
    const auto of = [](const Place& p, const Place& q) { return matern((p - q).norm()); };
    return (of(a.straight, b.straight) + of(a.straight, b.exchanged) + of(a.exchanged, b.straight) +
            of(a.exchanged, b.exchanged)) /
           (a.scale * b.scale);
}

KrigingPlace krigingPlace(const KrigingProcess& process, const LightView& pair) {
    KrigingPlace place{
        placeOf(process, pair), placeOf(process, {.in = pair.out, .out = pair.in}), 1};
    place.scale = std::sqrt(2 + 2 * matern((place.straight - place.exchanged).norm()));
    return place;
}

MatrixXd correlations(const std::vector<KrigingPlace>& at) {
    const auto n = static_cast<Index>(at.size());
    MatrixXd matrix(n, n);
    for (Index i = 0; i < n; ++i) {
        for (Index k = 0; k <= i; ++k) {
            matrix(i, k) = matrix(k, i) =
                correlation(at[static_cast<std::size_t>(i)], at[static_cast<std::size_t>(k)]);
        }
    }
    return matrix;
}

namespace {

/// Each value predicted from the others [Rasmussen2006, eqs. 5.10 to 5.12], the process's variance
/// being the one that makes them likeliest.
struct LeftOut {
    double logLikelihood = -std::numeric_limits<double>::infinity();
    double variance = 0;
};

LeftOut leaveOneOut(MatrixXd matrix, double noise, const VectorXd& y) {
    matrix.diagonal().array() += noise;
    const Eigen::LLT<MatrixXd> factor(matrix);
    if (factor.info() != Eigen::Success) return {};
    const Index n = y.size();
    const VectorXd inverse = factor.solve(MatrixXd::Identity(n, n)).diagonal();
    const VectorXd off = factor.solve(y).cwiseQuotient(inverse);
    LeftOut result;
    result.variance = off.array().square().matrix().cwiseProduct(inverse).mean();
    if (!(result.variance > 0)) return {};
    result.logLikelihood = 0.5 * inverse.array().log().sum() -
                           0.5 * static_cast<double>(n) * std::log(result.variance);
    return result;
}

/// What is known of a band, to learn the process from.
class Learning {
public:
    Learning(std::vector<LightView> pairs, VectorXd y)
        : pairs_(std::move(pairs)), y_(std::move(y)) {}

    /// One property after the other, twice: the best of its values with the others held.
    [[nodiscard]] KrigingProcess best() {
        for (int pass = 0; pass < 2; ++pass) {
            among({0.06, 0.12, 0.25, 0.5, 1, 2, 4}, &KrigingProcess::length);
            among({0, 1, 3}, &KrigingProcess::grazing);
            among({0.25, 1, 4}, &KrigingProcess::incidenceWeight);
            for (const bool fromMirror : {false, true}) {
                KrigingProcess tried = best_;
                tried.fromMirror = fromMirror;
                attempt(tried);
            }
        }
        return best_;
    }

private:
    void among(std::initializer_list<double> values, double KrigingProcess::*property) {
        for (const double value : values) {
            KrigingProcess tried = best_;
            tried.*property = value;
            attempt(tried);
        }
    }
    void attempt(KrigingProcess tried) {
        std::vector<KrigingPlace> at;
        for (const LightView& pair : pairs_) at.push_back(krigingPlace(tried, pair));
        const MatrixXd matrix = correlations(at);
        for (const double noise : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
            const LeftOut result = leaveOneOut(matrix, noise, y_);
            if (!(result.logLikelihood > most_)) continue;
            most_ = result.logLikelihood;
            tried.noise = noise;
            tried.variance = result.variance;
            tried.learned = true;
            best_ = tried;
        }
    }

    std::vector<LightView> pairs_;
    VectorXd y_;
    KrigingProcess best_;
    double most_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

KrigingProcess learnedProcess(const std::vector<LightView>& pairs, const VectorXd& values) {
    return Learning(pairs, values).best();
}

}  // namespace gonio::proc
