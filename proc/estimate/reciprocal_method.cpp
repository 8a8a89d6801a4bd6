#include "proc/estimate/reciprocal_method.h"

#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

Reach blended(const Reach& a, const Reach& b, double t) {
    return {.between = (1 - t) * a.between + t * b.between,
            .beyondIncidence = a.beyondIncidence * (1 - t) + b.beyondIncidence * t,
            .steps = (1 - t) * a.steps + t * b.steps};
}

/// The denominator of a way's weight.
double distanceOf(const Reach& reach) {
    const double off = beyond(reach);
    return reach.between * reach.between + off * off + 1e-6;
}

BandWay wayOf(const Reach& near, const Reach& far) {
    const double a = 1 / distanceOf(near);
    const double b = 1 / distanceOf(far);
    const double t = b / (a + b);
    return {
        .reach = blended(near, far, t), .exchanged = t, .off = std::min(beyond(near), beyond(far))};
}

/// Of the random errors of the two ways.
double correlationOf(const LightView& straight, const LightView& exchanged) {
    const double apart = angleBetween({.in = straight.in, .out = exchanged.in}).degrees() +
                         angleBetween({.in = straight.out, .out = exchanged.out}).degrees();
    return std::max(0.0, 1 - apart);
}

}  // namespace

double beyond(const Reach& reach) {
    return std::hypot(reach.beyondIncidence.degrees() / 5, reach.steps / 3);
}

ReciprocalAnswer reciprocalAnswer(const IncidenceMethod& method,
                                  const Coverage& coverage,
                                  const LightView& pair) {
    const LightView straight = withLightAtZero(pair);
    const LightView exchanged = withLightAtZero({.in = pair.out, .out = pair.in});
    const std::array<Reach, 3> near = coverage.at(straight);
    ReciprocalAnswer answer{.value = method.at(straight), .ways = {}};
    if (!coverage.exchanges()) {
        for (std::size_t b = 0; b < 3; ++b) answer.ways[b] = {near[b], 0, beyond(near[b])};
        return answer;
    }
    const std::array<Reach, 3> far = coverage.at(exchanged);
    for (std::size_t b = 0; b < 3; ++b) answer.ways[b] = wayOf(near[b], far[b]);
    if (!method.anchored()) return answer;
    const MethodAnswer one = answer.value;
    const MethodAnswer other = method.at(exchanged);
    const double correlation = correlationOf(straight, exchanged);
    for (const Band band : kBands) {
        const double t = answer.ways[index(band)].exchanged;
        const double u = (1 - t) * one.uRandom[band];
        const double v = t * other.uRandom[band];
        answer.value.f[band] = (1 - t) * one.f[band] + t * other.f[band];
        answer.value.uRandom[band] = std::sqrt(u * u + v * v + 2 * correlation * u * v);
        answer.value.uSystematic[band] =
            (1 - t) * one.uSystematic[band] + t * other.uSystematic[band];
    }
    return answer;
}

}  // namespace gonio::proc
