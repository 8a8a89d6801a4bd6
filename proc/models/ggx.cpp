#include "proc/models/ggx.h"

#include <cmath>

namespace gonio::proc {

// D = 1 / (pi ax ay hz^4 (1 + tan^2)^2) with tan^2 = (hx/(ax hz))^2 + (hy/(ay hz))^2 of the unit h.
// With H = wi + wo, l = |H|^2, e = (Hx/ax)^2 + (Hy/ay)^2 + Hz^2: D = (l / e)^2 / (pi ax ay).
double ggxD(const Eigen::Vector3d& half, GgxAlpha alpha) {
    const double sx = half.x() / alpha.x;
    const double sy = half.y() / alpha.y;
    const double z2 = half.z() * half.z();
    const double ratio = half.squaredNorm() / (sx * sx + sy * sy + z2);
    return ratio * ratio / (kPi * alpha.x * alpha.y);
}

// (sqrt(1 + x) - 1) / 2 loses all digits for small x; x / (2 (1 + sqrt(1 + x))) none.
double ggxLambda(const Direction& w, GgxAlpha alpha) {
    const double ax = alpha.x * w.x();
    const double ay = alpha.y * w.y();
    const double x = (ax * ax + ay * ay) / (w.z() * w.z());
    return x / (2 * (1 + std::sqrt(1 + x)));
}

double ggxV(const LightView& pair, GgxAlpha alpha, Masking masking) {
    const double muI = pair.in.z();
    const double muO = pair.out.z();
    // mu sqrt(1 + (a tan)^2), without a division by mu.
    const auto root = [&](const Direction& w) {
        const double ax = alpha.x * w.x();
        const double ay = alpha.y * w.y();
        return std::sqrt(ax * ax + ay * ay + w.z() * w.z());
    };
    const double rootI = root(pair.in);
    const double rootO = root(pair.out);
    if (masking == Masking::HeightCorrelated) return 0.5 / (muO * rootI + muI * rootO);
    return 1 / ((muI + rootI) * (muO + rootO));
}

LedBands schlick(LedBands f0, double cosine) {
    const double c = 1 - cosine;
    const double c2 = c * c;
    const double weight = c2 * c2 * c;
    LedBands f;
    for (Band b : kBands) f[b] = f0[b] + (1 - f0[b]) * weight;
    return f;
}

LedBands Ggx::evaluate(const LightView& pair) const {
    const Eigen::Vector3d half = pair.in.vector() + pair.out.vector();
    const double cosDiff = std::min(1.0, half.norm() / 2);
    const double dv = ggxD(half, alpha_) * ggxV(pair, alpha_, masking_);
    return schlick(f0_, cosDiff) * dv;
}

}  // namespace gonio::proc
