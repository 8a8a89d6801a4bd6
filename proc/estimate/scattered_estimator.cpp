#include "proc/estimate/scattered_estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "proc/core/median.h"
#include "proc/estimate/carrier_fit.h"
#include "proc/fit/common_uncertainty.h"

namespace gonio::proc {
namespace {

using Eigen::VectorXd;
using Index = Eigen::Index;

/// Of the median |f|, added to f and the model before their ratio is taken: what is far darker is
/// interpolated as a difference.
constexpr double kFloorShare = 0.1;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// But for a turn of both about the normal.
bool samePair(const LightView& a, const LightView& b) {
    constexpr double kSame = 1e-9;
    const LightView one = isotropicPair(a);
    const LightView other = isotropicPair(b);
    return (one.in.vector() - other.in.vector()).norm() < kSame &&
           (one.out.vector() - other.out.vector()).norm() < kSame;
}

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

/// The process of a few hundred of a band's samples, evenly taken.
KrigingProcess learned(const std::vector<KrigingSample>& samples, const VectorXd& ratios) {
    constexpr std::size_t kMost = 300;
    const std::size_t stride = std::max<std::size_t>(1, (samples.size() + kMost - 1) / kMost);
    std::vector<LightView> pairs;
    for (std::size_t i = 0; i < samples.size(); i += stride) pairs.push_back(samples[i].pair);
    VectorXd taken(static_cast<Index>(pairs.size()));
    for (Index i = 0; i < taken.size(); ++i) taken(i) = ratios(i * static_cast<Index>(stride));
    return learnedProcess(pairs, taken);
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
    const std::vector<LightView> pairs = pairsOf(data);
    for (std::size_t b = 0; b < data.bandsUsed(); ++b)
        made->bandsOf_[b] = made->learn(
            data, pairs, {.band = b, .neighbours = std::max<std::size_t>(1, options.neighbours)});
    return std::unique_ptr<const ScatteredEstimator>(std::move(made));
}

ScatteredEstimator::OneBand ScatteredEstimator::learn(const BrdfData& data,
                                                      const std::vector<LightView>& pairs,
                                                      const Learning& what) const {
    const std::size_t band = what.band;
    OneBand one;
    std::vector<double> ratios;
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
        ratios.push_back((row.f[band] + one.floor) / (model + one.floor) - 1);
        one.samples.push_back({.pair = pairs[i],
                               .f = row.f[band],
                               .uRandom = data.uKnown ? row.uRandom[band] : kNan,
                               .uSystematic = data.uKnown ? row.uSystematic[band] : kNan});
    }
    const VectorXd values =
        Eigen::Map<const VectorXd>(ratios.data(), static_cast<Index>(ratios.size()));
    one.process = learned(one.samples, values);
    std::vector<KrigingPlace> places;
    for (const KrigingSample& sample : one.samples) {
        places.push_back(krigingPlace(one.process, sample.pair));
    }
    one.kriging = LocalKriging(one.process, std::move(places), values, what.neighbours);
    one.commonRelative = commonRelative(data, band);
    return one;
}

ScatteredEstimator::BandAnswer ScatteredEstimator::bandAnswer(const LightView& pair,
                                                              std::size_t band) const {
    const OneBand& one = bandsOf_[band];
    if (one.samples.empty()) return {};
    const KrigingPlace here = krigingPlace(one.process, pair);
    // A pair shares its place with its mirror image, both exchanged, and those measured again.
    constexpr std::size_t kTwins = 16;
    const std::vector<std::uint32_t> near = one.kriging.nearest(here, kTwins);
    for (const std::uint32_t i : near) {
        const KrigingSample& sample = one.samples[i];
        if (!samePair(sample.pair, pair)) continue;
        return {sample.f, sample.uRandom, sample.uSystematic, Source::Measured};
    }
    const Kriged kriged = one.kriging.at(here, near.front());
    const double model = carrier_.at(pair).value[band] + one.floor;
    const double f = (1 + kriged.value) * model - one.floor;
    const auto deviation = [&](double share) {
        return one.process.learned ? model * std::sqrt(one.process.variance * share) : kNan;
    };
    const double own = deviation(kriged.unknown);
    const double common = one.commonRelative * std::abs(f);
    constexpr double kMostUnknown = 0.5;
    return {f,
            deviation(one.process.noise),
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
    BandAnswer one;
    for (const Band band : kBands) {
        if (band == Band::R || bands_ == BandCount::Three) one = bandAnswer(pair, index(band));
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
