#include "proc/estimate/scattered_estimator.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "proc/core/median.h"
#include "proc/estimate/carrier_fit.h"
#include "proc/fit/common_uncertainty.h"

namespace gonio::proc {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Index = Eigen::Index;
using Place = Eigen::Vector3d;
using Process = ScatteredEstimator::Process;

/// Of the median |f|, added to f and the model before their ratio is taken: what is far darker is
/// interpolated as a difference.
constexpr double kFloorShare = 0.1;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// But for a turn of both about the normal.
bool samePair(const LightView& a, const LightView& b) {
    constexpr double kSame = 1e-9;
    const LightView one = withLightAtZero(a);
    const LightView other = withLightAtZero(b);
    return (one.in.vector() - other.in.vector()).norm() < kSame &&
           (one.out.vector() - other.out.vector()).norm() < kSame;
}

/// Coordinates of a pair under a process: distances of such places are Euclidean.
Place placeOf(const Process& process, const LightView& pair) {
    const LightView straight = withLightAtZero(pair);
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

/// Correlation of two pairs; of one with itself it is 1. All four ways count: exchanging light and
/// view does not keep distances.
double alike(const KrigingPlace& a, const KrigingPlace& b) {
    const auto of = [](const Place& p, const Place& q) { return matern((p - q).norm()); };
    return (of(a.straight, b.straight) + of(a.straight, b.exchanged) + of(a.exchanged, b.straight) +
            of(a.exchanged, b.exchanged)) /
           (a.scale * b.scale);
}

KrigingPlace krigingPlace(const Process& process, const LightView& pair) {
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
                alike(at[static_cast<std::size_t>(i)], at[static_cast<std::size_t>(k)]);
        }
    }
    return matrix;
}

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
    [[nodiscard]] Process best() {
        for (int pass = 0; pass < 2; ++pass) {
            among({0.06, 0.12, 0.25, 0.5, 1, 2, 4}, &Process::length);
            among({0, 1, 3}, &Process::grazing);
            among({0.25, 1, 4}, &Process::incidenceWeight);
            for (const bool fromMirror : {false, true}) {
                Process tried = best_;
                tried.fromMirror = fromMirror;
                attempt(tried);
            }
        }
        return best_;
    }

private:
    void among(std::initializer_list<double> values, double Process::*property) {
        for (const double value : values) {
            Process tried = best_;
            tried.*property = value;
            attempt(tried);
        }
    }
    void attempt(Process tried) {
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
    Process best_;
    double most_ = -std::numeric_limits<double>::infinity();
};

std::vector<LightView> pairsOf(const BrdfData& data) {
    std::vector<LightView> pairs;
    for (const FitRow& row : data.rows) {
        pairs.push_back(viewOf(data.nodesOf(row).front().pair));
    }
    return pairs;
}

Result<Carrier> carrierOf(const BrdfData& data, const std::vector<std::string>& families) {
    CarrierFitOptions how{.rows = 4000, .families = families};
    if (how.families.empty()) {
        how.families = carrierFamilies();
        how.families.emplace_back("lambert");
    }
    const Carriers carriers =
        fitCarriers(data, std::vector<bool>(data.incidences.size(), true), how);
    const auto best = bestByChiSquare(data, carriers);
    if (best) return carriers.at(*best);
    return Error{ErrorKind::Quality, "estimate: no model can be fitted to the samples"};
}

/// A few hundred of a band's samples, evenly.
Process learned(const std::vector<KrigingSample>& samples) {
    constexpr std::size_t kMost = 300;
    const std::size_t stride = std::max<std::size_t>(1, (samples.size() + kMost - 1) / kMost);
    std::vector<LightView> pairs;
    std::vector<double> y;
    for (std::size_t i = 0; i < samples.size(); i += stride) {
        pairs.push_back(samples[i].pair);
        y.push_back(samples[i].ratio);
    }
    return Learning(std::move(pairs), Eigen::Map<VectorXd>(y.data(), static_cast<Index>(y.size())))
        .best();
}

/// The samples that resemble a place most.
struct Near {
    std::vector<std::size_t> sample;
    VectorXd alike;
};

Near nearest(const std::vector<KrigingSample>& samples,
             const KrigingPlace& here,
             std::size_t count) {
    std::vector<std::pair<double, std::size_t>> order(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) order[i] = {-alike(here, samples[i].place), i};
    count = std::min(count, order.size());
    std::partial_sort(
        order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
    Near near;
    near.alike.resize(static_cast<Index>(count));
    for (std::size_t i = 0; i < count; ++i) {
        near.sample.push_back(order[i].second);
        near.alike(static_cast<Index>(i)) = -order[i].first;
    }
    return near;
}

/// Of the ratio at a place.
struct Kriged {
    double ratio = 0;
    double unknown = 1;  ///< share of the process's variance that the samples leave open
};

Kriged krige(const std::vector<KrigingSample>& samples, const Near& near, double noise) {
    std::vector<KrigingPlace> at;
    VectorXd y(near.alike.size());
    for (std::size_t i = 0; i < near.sample.size(); ++i) {
        const KrigingSample& sample = samples[near.sample[i]];
        at.push_back(sample.place);
        y(static_cast<Index>(i)) = sample.ratio;
    }
    MatrixXd matrix = correlations(at);
    matrix.diagonal().array() += noise;
    const Eigen::LLT<MatrixXd> factor(matrix);
    return {near.alike.dot(factor.solve(y)),
            std::max(0.0, 1 - near.alike.dot(factor.solve(near.alike)))};
}

/// Empty where nothing is known in any band.
std::optional<LedBands> ifKnown(const LedBands& u) {
    const bool known =
        std::any_of(u.value.begin(), u.value.end(), [](double v) { return !std::isnan(v); });
    return known ? std::optional(u) : std::nullopt;
}

}  // namespace

Result<std::unique_ptr<const ScatteredEstimator>> ScatteredEstimator::over(
    const BrdfData& data, const ScatteredEstimatorOptions& options) {
    constexpr std::size_t kFewest = 8;
    if (data.rows.size() < kFewest) {
        return Error{ErrorKind::Quality,
                     "estimate: " + std::to_string(data.rows.size()) +
                         " BRDF samples are too few to interpolate between, wanted at least 8"};
    }
    const Result<Carrier> carrier = carrierOf(data, options.carriers);
    if (!carrier) return carrier.error();
    std::unique_ptr<ScatteredEstimator> made(new ScatteredEstimator(*carrier, data.bands));
    made->neighbours_ = std::max<std::size_t>(1, options.neighbours);
    made->uKnown_ = data.uKnown;
    const std::vector<LightView> pairs = pairsOf(data);
    for (std::size_t b = 0; b < data.bandsUsed(); ++b)
        made->bandsOf_[b] = made->learn(data, pairs, b);
    return std::unique_ptr<const ScatteredEstimator>(std::move(made));
}

ScatteredEstimator::OneBand ScatteredEstimator::learn(const BrdfData& data,
                                                      const std::vector<LightView>& pairs,
                                                      std::size_t band) const {
    OneBand one;
    std::vector<double> sizes;
    for (const FitRow& row : data.rows) {
        if (!std::isnan(row.f[band])) sizes.push_back(std::abs(row.f[band]));
    }
    if (sizes.empty()) return one;
    one.floor = kFloorShare * median(sizes);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const FitRow& row = data.rows[i];
        if (std::isnan(row.f[band])) continue;
        const double model = carrier_.at(pairs[i]).value[band];
        one.samples.push_back({.pair = pairs[i],
                               .place = {},
                               .ratio = (row.f[band] + one.floor) / (model + one.floor) - 1,
                               .f = row.f[band],
                               .uRandom = data.uKnown ? row.uRandom[band] : kNan,
                               .uSystematic = data.uKnown ? row.uSystematic[band] : kNan});
    }
    one.process = learned(one.samples);
    for (KrigingSample& sample : one.samples) sample.place = krigingPlace(one.process, sample.pair);
    one.commonRelative = commonRelative(data, band);
    return one;
}

ScatteredEstimator::BandAnswer ScatteredEstimator::bandAnswer(const LightView& pair,
                                                              std::size_t band) const {
    const OneBand& one = bandsOf_[band];
    if (one.samples.empty()) return {};
    const KrigingPlace here = krigingPlace(one.process, pair);
    const Near near = nearest(one.samples, here, neighbours_);
    for (const std::size_t i : near.sample) {
        const KrigingSample& sample = one.samples[i];
        if (!samePair(sample.pair, pair)) continue;
        return {sample.f, sample.uRandom, sample.uSystematic, Source::Measured};
    }
    const Kriged kriged = krige(one.samples, near, one.process.noise);
    const double model = carrier_.at(pair).value[band] + one.floor;
    const double f = (1 + kriged.ratio) * model - one.floor;
    const double own =
        one.process.learned ? model * std::sqrt(one.process.variance * kriged.unknown) : kNan;
    const double common = one.commonRelative * std::abs(f);
    constexpr double kMostUnknown = 0.5;
    return {f,
            uKnown_ ? 0 : kNan,
            std::sqrt(own * own + common * common),
            kriged.unknown > kMostUnknown ? Source::Model : Source::Interpolated};
}

Answer ScatteredEstimator::answer(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    }
    Answer answer;
    answer.uRandom = LedBands{};
    answer.uSystematic = LedBands{};
    answer.source = Source::Measured;
    for (const Band band : kBands) {
        const BandAnswer one = bandAnswer(pair, bands_ == BandCount::One ? 0 : index(band));
        answer.f[band] = one.f;
        (*answer.uRandom)[band] = one.uRandom;
        (*answer.uSystematic)[band] = one.uSystematic;
        // The least trusted of the bands.
        if (one.source == Source::Model || answer.source == Source::Measured) {
            answer.source = one.source;
        }
    }
    answer.uRandom = ifKnown(*answer.uRandom);
    answer.uSystematic = ifKnown(*answer.uSystematic);
    switch (answer.source) {
        case Source::Measured: answer.flags.set(Flag::Measured); break;
        case Source::Model: answer.flags.set(Flag::Extrapolated).set(Flag::Model); break;
        default: answer.flags.set(Flag::Interpolated).set(Flag::Model); break;
    }
    return answer;
}

}  // namespace gonio::proc
