#include "proc/estimate/rotation_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "proc/table/axis.h"

namespace gonio::proc {
namespace {

constexpr Radians kNormal = 1e-6_deg;

void widen(Answer& answer, const LedBands& by) {
    LedBands u = answer.uSystematic.value_or(LedBands{});
    for (const Band band : kBands) u[band] = std::hypot(u[band], by[band]);
    answer.uSystematic = u;
}

/// What the answer rests on least: the order of the sources is that of trust.
Source weaker(Source a, Source b) { return std::max({a, b, Source::Interpolated}); }

Answer between(const Answer& low, const Answer& high, double t) {
    if (!low.present() || !high.present())
        return Answer::none(low.flags | high.flags, Source::Interpolated);
    Answer answer = low;
    answer.f = low.f * (1 - t) + high.f * t;
    answer.flags = low.flags | high.flags;
    answer.flags.clear(Flag::Measured).set(Flag::Interpolated);
    answer.source = weaker(low.source, high.source);
    const LedBands none;
    LedBands random, systematic, off;
    for (const Band band : kBands) {
        random[band] = std::hypot((1 - t) * low.uRandom.value_or(none)[band],
                                  t * high.uRandom.value_or(none)[band]);
        systematic[band] = (1 - t) * low.uSystematic.value_or(none)[band] +
                           t * high.uSystematic.value_or(none)[band];
        off[band] = t * (1 - t) * (high.f[band] - low.f[band]);
    }
    answer.uRandom = random;
    answer.uSystematic = systematic;
    widen(answer, off);
    return answer;
}

}  // namespace

Result<std::unique_ptr<const RotationEstimator>> RotationEstimator::over(
    const std::vector<Radians>& rotations, const Make& of) {
    auto made = std::make_unique<RotationEstimator>();
    for (const Radians rotation : rotations) {
        auto estimator = of(rotation);
        if (!estimator) return estimator.error();
        made->turns_.push_back({rotation, std::move(*estimator)});
        made->rotationDeg_.push_back(rotation.degrees());
    }
    return std::unique_ptr<const RotationEstimator>(std::move(made));
}

Answer RotationEstimator::nearest(const LightView& inRig, double azimuthDeg) const {
    const auto away = [&](const Turn& turn) {
        return std::abs(std::remainder(turn.rotation.degrees() - azimuthDeg, 360));
    };
    const auto near =
        std::min_element(turns_.begin(), turns_.end(), [&](const Turn& a, const Turn& b) {
            return away(a) < away(b);
        });
    Answer answer = near->estimator->answer(inRig);
    LedBands least = answer.f, most = answer.f;
    for (const Turn& turn : turns_) {
        const Answer other = turn.estimator->answer(inRig);
        for (const Band band : kBands) {
            least[band] = std::fmin(least[band], other.f[band]);
            most[band] = std::fmax(most[band], other.f[band]);
        }
    }
    widen(answer, (most + least * -1) * 0.5);
    answer.flags.clear(Flag::Measured).set(Flag::Extrapolated);
    answer.source = std::max(answer.source, Source::Extrapolated);
    return answer;
}

Answer RotationEstimator::answer(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon())
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    if (pair.in.theta() < kNormal) {
        const Turn& first = turns_.front();
        return first.estimator->answer({.in = {}, .out = pair.out.turned(first.rotation)});
    }
    const Radians phi = pair.in.phi();
    const LightView inRig{.in = Direction::fromSpherical(pair.in.theta(), Radians(0)),
                          .out = pair.out.turned(-phi)};
    const auto place = placeOnCircle(rotationDeg_, -phi.degrees());
    if (!place) return nearest(inRig, -phi.degrees());
    const Answer low = turns_[place->low].estimator->answer(inRig);
    if (place->atNode()) return low;
    return between(low, turns_[place->high].estimator->answer(inRig), place->t);
}

}  // namespace gonio::proc
