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

}  // namespace

double beyond(const Reach& reach) {
    return std::hypot(reach.beyondIncidence.degrees() / 5, reach.steps / 3);
}

ReciprocalAnswer reciprocalAnswer(const IncidenceMethod& method,
                                  const Coverage& coverage,
                                  const LightView& pair) {
    const LightView straight = withLightAtZero(pair);
    const LightView exchanged = withLightAtZero({.in = pair.out, .out = pair.in});
    const Reach near = coverage.at(straight);
    const Reach far = coverage.at(exchanged);
    const double a = 1 / distanceOf(near);
    const double b = 1 / distanceOf(far);
    const double t = b / (a + b);
    ReciprocalAnswer answer{.value = method.at(straight),
                            .reach = blended(near, far, t),
                            .exchanged = t,
                            .off = std::min(beyond(near), beyond(far))};
    if (!method.anchored()) return answer;
    const MethodAnswer one = answer.value;
    const MethodAnswer other = method.at(exchanged);
    for (const Band band : kBands) {
        answer.value.f[band] = (1 - t) * one.f[band] + t * other.f[band];
        answer.value.uRandom[band] =
            std::hypot((1 - t) * one.uRandom[band], t * other.uRandom[band]);
        answer.value.uSystematic[band] =
            (1 - t) * one.uSystematic[band] + t * other.uSystematic[band];
    }
    return answer;
}

}  // namespace gonio::proc
