#include "proc/models/oren_nayar.h"

#include <algorithm>

namespace gonio::proc {

OrenNayar::OrenNayar(LedBands albedo, Radians sigma) : albedo_(albedo) {
    const double s2 = sigma.value() * sigma.value();
    a_ = 1 - 0.5 * s2 / (s2 + 0.33);
    b_ = 0.45 * s2 / (s2 + 0.09);
}

LedBands OrenNayar::evaluate(const LightView& pair) const {
    const Direction& wi = pair.in;
    const Direction& wo = pair.out;
    const double cross = wi.x() * wo.x() + wi.y() * wo.y();
    const double sinTan = std::max(0.0, cross) / std::max(wi.z(), wo.z());
    return albedo_ * ((a_ + b_ * sinTan) / kPi);
}

}  // namespace gonio::proc
