#include "proc/core/direction.h"

#include <cmath>
#include <limits>

namespace gonio {

Direction Direction::fromSpherical(Radians theta, Radians phi) {
    const double s = sin(theta);
    return Direction(Eigen::Vector3d(s * cos(phi), s * sin(phi), cos(theta)));
}

std::optional<Direction> Direction::fromVector(const Eigen::Vector3d& v) {
    const double largest = v.cwiseAbs().maxCoeff();
    if (!v.allFinite() || largest < std::numeric_limits<double>::min()) return std::nullopt;
    const Eigen::Vector3d scaled = v / largest;  // no overflow or underflow in the norm
    return Direction(scaled / scaled.norm());
}

Radians Direction::theta() const { return Radians(std::atan2(std::hypot(v_.x(), v_.y()), v_.z())); }

Radians Direction::phi() const {
    if (v_.x() == 0 && v_.y() == 0) return Radians(0);
    const double phi = std::atan2(v_.y(), v_.x());
    if (phi >= 0) return Radians(phi);
    const double wrapped = phi + 2 * kPi;
    return Radians(wrapped < 2 * kPi ? wrapped : 0.0);
}

Direction Direction::turned(Radians angle) const {
    const double c = cos(angle);
    const double s = sin(angle);
    return Direction(Eigen::Vector3d(c * v_.x() - s * v_.y(), s * v_.x() + c * v_.y(), v_.z()));
}

Radians angleBetween(const LightView& pair) {
    const Eigen::Vector3d& a = pair.in.vector();
    const Eigen::Vector3d& b = pair.out.vector();
    return Radians(2 * std::atan2((a - b).norm(), (a + b).norm()));
}

Direction mirrorOf(const Direction& wi) {
    return *Direction::fromVector({-wi.x(), -wi.y(), wi.z()});
}

Direction acrossSurface(const Direction& w) {
    return *Direction::fromVector({w.x(), w.y(), -w.z()});
}

}  // namespace gonio
