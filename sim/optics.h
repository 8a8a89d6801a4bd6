#pragma once
// The simulated rig's own lens, drawn from its serial number; it shares no code with the host's
// lens map. The camera looks down on the sample: image x is sample x, image y (down) is sample -y,
// up to the drawn rotation. In lens coordinates (centre taken off, rotated, ellipse undone) the
// radius is
//   r = scale ((1 - m) theta + m 2 sin(theta / 2)), |m| <= 0.05,
// about 6.6 pixels per degree. The field stop is at 76 degrees and lies inside the 1024 x 1024
// window.

#include <cstdint>
#include <optional>
#include <string>

#include "proc/core/direction.h"

namespace gonio::sim {

/// A point in sensor pixels; (0, 0) is the corner of the first pixel.
struct ImagePoint {
    double x = 0;
    double y = 0;
};

class Optics {
public:
    /// `middle`: the middle of the window in sensor pixels.
    Optics(const std::string& serial, ImagePoint middle);

    /// The direction that falls on this point; empty outside the field stop.
    [[nodiscard]] std::optional<Direction> directionAt(ImagePoint at) const;
    [[nodiscard]] ImagePoint pixelOf(const Direction& wo) const;
    /// Solid angle per square pixel, relative to the middle of the field.
    [[nodiscard]] double relativeSolidAngle(const Direction& wo) const;
    /// Transmission relative to the middle: 1 there, falling by up to a fifth at the rim.
    [[nodiscard]] double vignetting(const Direction& wo) const;

private:
    [[nodiscard]] double radius(double theta) const;
    [[nodiscard]] double radiusSlope(double theta) const;

    ImagePoint centre_;
    double rotation_;  // radians
    double stretch_;   // ellipse: x is longer by this factor, y shorter, along ellipseAxis_
    double ellipseAxis_;
    double scale_;  // pixels per radian
    double mixture_;
    double falloff_;
};

}  // namespace gonio::sim
