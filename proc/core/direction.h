#pragma once
// Directions: unit vectors in the sample frame, right-handed, z = outward normal, phi from +x
// toward +y. wi points to the light, wo to the camera, both away from the surface. Only factories
// make a Direction, so every one is a unit vector (to 2 ulp).

#include <Eigen/Core>
#include <optional>

#include "proc/core/units.h"

namespace gonio {

class Direction {
public:
    /// The normal.
    Direction() : v_(0, 0, 1) {}

    /// theta from +z in [0, pi], phi from +x toward +y, any value.
    [[nodiscard]] static Direction fromSpherical(Radians theta, Radians phi);
    /// Normalised exactly, whatever the length; empty for a zero, denormal or non-finite vector.
    [[nodiscard]] static std::optional<Direction> fromVector(const Eigen::Vector3d& v);

    [[nodiscard]] double x() const { return v_.x(); }
    [[nodiscard]] double y() const { return v_.y(); }
    [[nodiscard]] double z() const { return v_.z(); }
    [[nodiscard]] const Eigen::Vector3d& vector() const { return v_; }

    /// Polar angle by atan2(hypot(x, y), z), exact to rounding at the poles too.
    [[nodiscard]] Radians theta() const;
    /// In [0, 2 pi); 0 at the poles.
    [[nodiscard]] Radians phi() const;
    [[nodiscard]] bool aboveHorizon() const { return v_.z() > 0; }

    /// This direction turned by `angle` about the normal, counter-clockwise seen from above.
    [[nodiscard]] Direction turned(Radians angle) const;

private:
    explicit Direction(const Eigen::Vector3d& v) : v_(v) {}
    Eigen::Vector3d v_;
};

/// Where the light is and where the camera is.
struct LightView {
    Direction in;
    Direction out;
};

/// Standard uncertainty of a direction along theta and along phi, both as angles on the sphere.
struct DirectionSpread {
    Radians alongTheta;
    Radians alongPhi;

    [[nodiscard]] static DirectionSpread even(Radians perAxis) { return {perAxis, perAxis}; }
    /// Root mean square of both.
    [[nodiscard]] Radians perAxis() const {
        return Radians(std::hypot(alongTheta.value(), alongPhi.value()) / std::sqrt(2.0));
    }
};

/// Angle between two directions, by the half-chord form: exact near 0 and near pi.
[[nodiscard]] Radians angleBetween(const LightView& pair);

/// The mirror direction of wi: (-x, -y, z).
[[nodiscard]] Direction mirrorOf(const Direction& wi);
/// On the other side of the surface: (x, y, -z).
[[nodiscard]] Direction acrossSurface(const Direction& w);

}  // namespace gonio
