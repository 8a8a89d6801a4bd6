#include "proc/radiance/scale_system.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

Eigen::Index signedIndex(std::size_t i) { return static_cast<Eigen::Index>(i); }

}  // namespace

ScaleSystem::ScaleSystem(std::size_t nodes)
    : h_(Eigen::MatrixXd::Zero(signedIndex(nodes), signedIndex(nodes))),
      g_(h_),
      a_(h_),
      b_(Eigen::VectorXd::Zero(signedIndex(nodes))) {}

void ScaleSystem::add(double light, std::span<const double> rate, std::span<const double> weight) {
    double sum = 0, sumRate = 0;
    int seen = 0;
    for (std::size_t i = 0; i < weight.size(); ++i) {
        sum += weight[i];
        sumRate += weight[i] * rate[i];
        seen += weight[i] > 0 ? 1 : 0;
    }
    if (seen < 2 || light <= 0) return;
    const double mean = sumRate / sum;
    for (std::size_t i = 0; i < weight.size(); ++i) {
        if (weight[i] == 0) continue;
        b_(signedIndex(i)) += light * weight[i] * (rate[i] - mean);
        for (std::size_t j = 0; j <= i; ++j) {
            const double p = (i == j ? weight[i] : 0) - weight[i] * weight[j] / sum;
            h_(signedIndex(i), signedIndex(j)) += light * mean * p;
            g_(signedIndex(i), signedIndex(j)) += light * light * p;
            a_(signedIndex(i), signedIndex(j)) += light * p;
        }
    }
}

void ScaleSystem::add(double light, std::span<const double> rate, const SharedWeights& weights) {
    double sum = 0, sumRate = 0;
    int seen = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum += weights.inMean(i);
        sumRate += weights.inMean(i) * rate[i];
        seen += weights.present(i) ? 1 : 0;
    }
    if (seen < 2 || light <= 0) return;
    const double mean = sumRate / sum;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (!weights.present(i)) continue;
        for (std::size_t j = 0; j < weights.size(); ++j) {
            if (!weights.present(j)) continue;
            const double w = weights.at(i, j);
            b_(signedIndex(i)) += light * w * (rate[j] - mean);
            if (j > i) continue;
            const double p = w - weights.inMean(i) * weights.inMean(j) / sum;
            h_(signedIndex(i), signedIndex(j)) += light * mean * p;
            g_(signedIndex(i), signedIndex(j)) += light * light * p;
            a_(signedIndex(i), signedIndex(j)) += light * p;
        }
    }
}

void ScaleSystem::add(const BlockOfPixels& light, std::span<const NodeBlock* const> nodes) {
    const PooledBlock block = pooled(light, nodes);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        b_(signedIndex(i)) += pullOf(block, *nodes[i]);
        for (std::size_t j = 0; j <= i; ++j) {
            const PairSums sums = pairSums(block, *nodes[i], *nodes[j], i == j);
            h_(signedIndex(i), signedIndex(j)) += sums.h;
            g_(signedIndex(i), signedIndex(j)) += sums.g;
        }
    }
}

ScaleSystem& ScaleSystem::operator+=(const ScaleSystem& other) {
    h_ += other.h_;
    g_ += other.g_;
    a_ += other.a_;
    b_ += other.b_;
    return *this;
}

std::optional<BrightnessOffset> ScaleSystem::along(const Eigen::VectorXd& pattern) const {
    const double information = pattern.dot(h_.selfadjointView<Eigen::Lower>() * pattern);
    const double variance = pattern.dot(g_.selfadjointView<Eigen::Lower>() * pattern);
    if (!(information > 0) || !(variance > 0)) return std::nullopt;
    return BrightnessOffset{pattern.dot(b_) / information, std::sqrt(variance) / information};
}

double ScaleSystem::seenAlong(const Eigen::VectorXd& pattern, const Eigen::VectorXd& off) const {
    const Eigen::VectorXd row = h_.selfadjointView<Eigen::Lower>() * pattern;
    return row.dot(off) / row.dot(pattern);
}

double ScaleSystem::addedAlong(const Eigen::VectorXd& pattern, const Eigen::VectorXd& added) const {
    const double information = pattern.dot(h_.selfadjointView<Eigen::Lower>() * pattern);
    return pattern.dot(a_.selfadjointView<Eigen::Lower>() * added) / information;
}

std::vector<BrightnessOffset> ScaleSystem::solve(std::span<const double> uNominal) const {
    Eigen::VectorXd nominal(b_.size());  // information of the nominal scales
    for (std::size_t i = 0; i < uNominal.size(); ++i)
        nominal(signedIndex(i)) = 1 / (uNominal[i] * uNominal[i]);
    Eigen::MatrixXd h = h_.selfadjointView<Eigen::Lower>();
    Eigen::MatrixXd g = g_.selfadjointView<Eigen::Lower>();
    h.diagonal() += nominal;
    g.diagonal() += nominal;
    const Eigen::LDLT<Eigen::MatrixXd> solver(h);
    const Eigen::VectorXd d = solver.solve(b_);
    const Eigen::MatrixXd covariance = solver.solve(solver.solve(g).transpose());
    std::vector<BrightnessOffset> offsets;
    for (Eigen::Index i = 0; i < d.size(); ++i)
        offsets.push_back({d(i), std::sqrt(std::max(covariance(i, i), 0.0))});
    return offsets;
}

std::optional<double> lightAround(const Image<float>& radiance, int x, int y) {
    if (x < 1 || y < 1 || x + 1 >= radiance.width() || y + 1 >= radiance.height())
        return std::nullopt;
    const float sum = radiance.at(x - 1, y) + radiance.at(x + 1, y) + radiance.at(x, y - 1) +
                      radiance.at(x, y + 1);
    if (!std::isfinite(sum)) return std::nullopt;
    return std::max(static_cast<double>(sum) / 4, 0.0);
}

}  // namespace gonio::proc
