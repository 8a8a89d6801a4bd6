#pragma once
// Angles as files hold them: degrees, rounded to 1e-9, so that 20 degrees that went through radians
// are written as 20 and read back to the same bits; or radians, rounded to 1e-12.

#include <cmath>

#include "proc/core/direction.h"
#include "proc/core/units.h"

namespace gonio::proc {

[[nodiscard]] inline double fileDegrees(Radians angle) {
    return std::round(angle.degrees() * 1e9) / 1e9 + 0.0;  // never -0
}

/// An azimuth in [0, 360).
[[nodiscard]] inline double fileAzimuthDegrees(Radians angle) {
    const double degrees = fileDegrees(angle);
    return degrees >= 360 ? degrees - 360 : degrees;
}

/// Radians of a file, and lengths on the sphere: rounded to 1e-12.
[[nodiscard]] inline double fileRadians(double value) {
    return std::round(value * 1e12) / 1e12 + 0.0;
}
/// A polar angle of a file in radians: what differs from pi/2 by rounding is on the horizon.
[[nodiscard]] inline Radians fromFileRadians(double theta) {
    const bool horizon = std::abs(theta - kPi / 2) < 1e-11;
    return Radians(horizon ? kPi / 2 : theta);
}

/// From the angles of a file: 90 degrees is on the horizon, not 6e-17 above it.
[[nodiscard]] inline Direction fileDirection(Radians theta, Radians phi) {
    const Direction w = Direction::fromSpherical(theta, phi);
    if (theta < Radians(kPi / 2) || w.z() <= 0) return w;
    return *Direction::fromVector({w.x(), w.y(), 0});
}

}  // namespace gonio::proc
