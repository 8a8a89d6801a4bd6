#include "proc/plan/information.h"

#include <algorithm>
#include <cmath>

namespace gonio::proc {

double ShotOption::framesFor(double rate, double wanted) const {
    if (rate > reach) return 0;
    if (wanted <= 0) return 1;
    const double room = tau * tau / wanted - darkVariance;
    return room > 0 ? std::max(1.0, std::ceil(single(rate) / room)) : 0;
}

ShotOption shotOption(const SensorModel& sensor, const ShotKind& kind, int darkFrames) {
    const SensorNoise noise = sensor.noiseNow();
    const double t = kind.exposure.count();
    const double c = noise.darkVariance(t);
    const double tau = t * kind.level;
    const double left = sensor.usableElectrons() - noise.darkElectronsPerSecond * t;
    return {.kind = kind,
            .tau = tau,
            .noise = c,
            .darkVariance = c / std::max(1, darkFrames),
            .reach = std::max(0.0, left) / tau};
}

}  // namespace gonio::proc
