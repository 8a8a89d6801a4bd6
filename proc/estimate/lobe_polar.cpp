#include "proc/estimate/lobe_polar.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gonio::proc {
namespace {

constexpr double kCore = 1.0 / (1 << 20);  ///< 16^-5

/// Share of a quarter turn, drawn to the end that is a right angle from the plane of incidence.
struct Turn {
    double phi, slope;
};
Turn turnAt(double x) {
    const int quarter = std::clamp(static_cast<int>(x), 0, LobePolar::kQuarters - 1);
    const double within = x - quarter;
    const bool towardsEnd = quarter % 2 == 0;
    const double away = towardsEnd ? 1 - within : within;
    const double side = quarter < 2 ? kPi / 2 : 3 * kPi / 2;
    const double offset = kPi / 2 * away * away * away;
    return {towardsEnd ? side - offset : side + offset, kPi / 2 * 3 * away * away};
}

}  // namespace

LobePolar::LobePolar(const Direction& wi)
    : mu_(wi.z()), sinTheta_(std::hypot(wi.x(), wi.y())), cosAzimuth_(1), sinAzimuth_(0) {
    if (sinTheta_ > 0) {
        cosAzimuth_ = wi.x() / sinTheta_;
        sinAzimuth_ = wi.y() / sinTheta_;
    }
}

Spoke LobePolar::spoke(double x) const {
    const Turn turn = turnAt(x);
    const double c = std::cos(turn.phi);
    const double along = sinTheta_ * c;
    const double root = std::hypot(along, mu_);
    // For the side away from the light, the other form of the same root: no difference.
    const double tMax = along > 0 ? (along + root) / mu_ : mu_ / (root - along);
    return {c, std::sin(turn.phi), tMax, turn.slope};
}

Ring LobePolar::ring(double y) {
    if (y < 1) return {kCore * y, kCore};
    const double share = kCore * std::exp2(4 * (y - 1));
    return {share, 4 * std::log(2.0) * share};
}

ProjectedNode LobePolar::at(const Spoke& spoke, const Ring& ring) const {
    const double t = spoke.tMax * ring.share;
    const double inverse = 1 / (1 + t * t);
    const double along = sinTheta_ * t * spoke.cosPhi + mu_;  // sqrt(1 + T^2) wi.h
    const double cosOut = mu_ * spoke.tMax * (1 - ring.share) * (t + 1 / spoke.tMax) * inverse;
    const double twice = 2 * along * inverse;
    const double x = twice * t * spoke.cosPhi - sinTheta_;
    const double y = twice * t * spoke.sinPhi;
    const Eigen::Vector3d wo(cosAzimuth_ * x - sinAzimuth_ * y,
                             sinAzimuth_ * x + cosAzimuth_ * y,
                             std::max(cosOut, std::numeric_limits<double>::min()));
    return {*Direction::fromVector(wo),
            4 * cosOut * along * inverse * inverse * t * spoke.tMax * ring.weight * spoke.weight};
}

}  // namespace gonio::proc
