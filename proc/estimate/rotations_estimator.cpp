#include "proc/estimate/rotations_estimator.h"

#include <algorithm>
#include <cmath>

#include "proc/estimate/answer_blend.h"
#include "proc/estimate/grid_data.h"
#include "proc/table/axis.h"
#include "proc/table/merged_info.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

/// Sees its pairs as the surface does that lies turned by r.
class Turned final : public Scatterer {
public:
    Turned(std::shared_ptr<const Scatterer> surface, Radians rotation)
        : surface_(std::move(surface)), rotation_(rotation) {}
    [[nodiscard]] Answer answer(const LightView& pair) const override {
        const LightView level = withLightAtZero(pair);
        return surface_->answer(
            {.in = level.in.turned(-rotation_), .out = level.out.turned(-rotation_)});
    }
    [[nodiscard]] BandCount bandCount() const override { return surface_->bandCount(); }

private:
    std::shared_ptr<const Scatterer> surface_;  ///< shared by all rotations
    Radians rotation_;
};

double turnOf(double degrees) {
    const double turn = std::fmod(degrees, 360);
    return turn < 0 ? turn + 360 : turn;
}

/// Between which two nodes of a circle, however far apart.
AxisPlace around(const std::vector<double>& deg, double at) {
    const auto next = std::upper_bound(deg.begin(), deg.end(), at);
    const std::size_t high = next == deg.end() ? 0 : static_cast<std::size_t>(next - deg.begin());
    const std::size_t low = high == 0 ? deg.size() - 1 : high - 1;
    const double gap = turnOf(deg[high] - deg[low]);
    return {low, high, gap > 0 ? turnOf(at - deg[low]) / gap : 0};
}

bool isNormal(const LightView& pair) { return pair.in.theta() < 1e-6_deg; }

void widen(Answer& answer, const LedBands& by) {
    if (!answer.uSystematic) return;
    for (const Band band : kBands) {
        double& u = (*answer.uSystematic)[band];
        if (!std::isnan(by[band])) u = std::hypot(u, by[band]);
    }
}

/// The order of the sources is that of trust.
Source weaker(Source a, Source b) { return std::max({a, b, Source::Interpolated}); }

}  // namespace

RotationsEstimator::RotationsEstimator(std::vector<Turn> turns) : turns_(std::move(turns)) {
    for (const Turn& turn : turns_) deg_.push_back(turn.rotation.degrees());
}

Result<std::unique_ptr<const RotationsEstimator>> RotationsEstimator::over(
    const SampleSet& set, const SampleEstimatorOptions& options) {
    std::vector<Turn> turns;
    for (const Radians rotation : rotationsOf(set)) {
        SampleSet part = unturned(tablesAt(set, rotation));
        BrdfData data = fitDataOf(part);
        data.exchanges = false;
        auto made = SampleEstimator::over(
            std::make_shared<const SampleLookup>(std::move(part)), std::move(data), options);
        if (!made) return made.error();
        turns.push_back({rotation, std::move(*made)});
    }
    return std::unique_ptr<const RotationsEstimator>(new RotationsEstimator(std::move(turns)));
}

Result<std::unique_ptr<const RotationsEstimator>> RotationsEstimator::over(
    const std::shared_ptr<const Scatterer>& measured,
    std::vector<Radians> rotations,
    const std::vector<Radians>& incidences,
    const DataOptions& assumed,
    const SampleEstimatorOptions& options) {
    std::sort(rotations.begin(), rotations.end());
    std::vector<Turn> turns;
    for (const Radians rotation : rotations) {
        auto part = std::make_shared<const Turned>(measured, rotation);
        BrdfData data = gridDataOf(*part, incidences, assumed);
        data.exchanges = false;
        auto made = SampleEstimator::over(std::move(part), std::move(data), options);
        if (!made) return made.error();
        turns.push_back({rotation, std::move(*made)});
    }
    return std::unique_ptr<const RotationsEstimator>(new RotationsEstimator(std::move(turns)));
}

BandCount RotationsEstimator::bandCount() const { return turns_.front().estimator->bandCount(); }

Answer RotationsEstimator::ofTurn(std::size_t turn, const LightView& pair) const {
    // At the normal the view alone says how the sample lay.
    const LightView at{.in = pair.in,
                       .out = isNormal(pair) ? pair.out.turned(turns_[turn].rotation) : pair.out};
    return turns_[turn].estimator->answer(at);
}

std::optional<LedBands> RotationsEstimator::chordError(const AxisPlace& place,
                                                       const LightView& pair,
                                                       const Answer& low,
                                                       const Answer& high) const {
    const std::size_t count = turns_.size();
    const std::size_t before = (place.low + count - 1) % count;
    const std::size_t after = (place.high + 1) % count;
    const double step = turnOf(deg_[place.high] - deg_[place.low]);
    const auto isNear = [&](std::size_t from, std::size_t to) {
        return turnOf(deg_[to] - deg_[from]) <= 1.5 * step;
    };
    LedBands second;
    bool known = false;
    const auto bend = [&](const Answer& a, const Answer& b, const Answer& c) {
        known = true;
        for (const Band band : kBands) {
            const double d = std::abs(a.f[band] - 2 * b.f[band] + c.f[band]);
            second[band] = std::fmax(second[band], d);
        }
    };
    if (count > 2 && isNear(before, place.low)) bend(ofTurn(before, pair), low, high);
    if (count > 2 && isNear(place.high, after)) bend(low, high, ofTurn(after, pair));
    if (!known) return std::nullopt;
    const double weight = place.t * (1 - place.t);
    LedBands error;
    for (const Band band : kBands) {
        error[band] =
            weight * std::fmax(0.5 * second[band], 2 * std::abs(high.f[band] - low.f[band]));
    }
    return error;
}

Answer RotationsEstimator::answer(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    }
    if (isNormal(pair)) return ofTurn(0, pair);
    const double at = turnOf(-pair.in.phi().degrees());
    const auto enclosed = placeOnCircle(deg_, at);
    const AxisPlace place = enclosed.value_or(around(deg_, at));
    const Answer low = ofTurn(place.low, pair);
    if (place.atNode()) return low;
    const Answer high = ofTurn(place.high, pair);
    AnswerBlend blend;
    blend.add(1 - place.t, low);
    blend.add(place.t, high);
    Answer answer = blend.sum(enclosed ? weaker(low.source, high.source) : Source::Extrapolated);
    const auto error = enclosed ? chordError(place, pair, low, high) : std::nullopt;
    if (error) {
        widen(answer, *error);
    } else {
        answer.uRandom.reset();
        answer.uSystematic.reset();
    }
    return answer;
}

}  // namespace gonio::proc
