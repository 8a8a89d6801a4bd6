#include "proc/estimate/seed_albedo.h"

#include <cmath>

namespace gonio::proc {

LedBands riemannAlbedo(const Scatterer& of, const Direction& wi, int lastDegree) {
    constexpr double kStep = kPi / 180;
    LedBands sum;
    for (int row = 0; row <= lastDegree; ++row) {
        const Radians theta = Radians::fromDegrees(row);
        const double weight = sin(theta) * cos(theta) * kStep * kStep;
        for (int column = 0; column < 360; ++column) {
            const Direction wo = Direction::fromSpherical(theta, Radians::fromDegrees(column));
            const Answer answer = of.answer({.in = wi, .out = wo});
            for (const Band band : kBands) {
                if (std::isfinite(answer.f[band])) sum[band] += weight * answer.f[band];
            }
        }
    }
    return sum;
}

}  // namespace gonio::proc
