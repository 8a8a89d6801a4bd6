#pragma once
// Where on the sensor a direction falls. The camera looks down on the sample: image x is sample x,
// image y (down) is sample -y, up to a rotation. With p a point in sensor pixels,
//     (u, v) = exp([a b; b -a]) (p - centre)          an ellipse of equal area
//     r = |(u, v)| / kRadiusScale, theta = c1 r + c3 r^3 + c5 r^5
//     phi = atan2(-v, u) - rotation.
// An odd polynomial is what conoscopic optics, f-theta and f-sin alike, are near (radiometry.md
// 2.4). Valid where theta rises with r; beyond maxTheta() there is no direction.
//
// At the centre: theta = 0, the normal. Beyond the field: empty, never a wrapped direction.

#include <array>
#include <optional>
#include <span>

#include "proc/core/direction.h"

namespace gonio::proc {

/// A point in sensor pixels; (0, 0) is the corner of the first pixel of the full sensor.
struct SensorPoint {
    double x = 0;
    double y = 0;
};

class LensMap {
public:
    /// Sensor pixels per unit of r: keeps the coefficients of one size.
    static constexpr double kRadiusScale = 500;
    static constexpr std::size_t kParameters = 8;

    struct Parameters {
        double centreX = 0, centreY = 0;  ///< sensor pixels
        double rotation = 0;              ///< radians, counter-clockwise seen from above
        double a = 0, b = 0;              ///< of the ellipse
        double c1 = 0, c3 = 0, c5 = 0;    ///< radians
        bool operator==(const Parameters&) const = default;
    };

    explicit LensMap(const Parameters& parameters);
    /// Even f-theta about `centre`: the guess that a fit starts from.
    [[nodiscard]] static LensMap fTheta(SensorPoint centre, double pixelsPerDegree);

    [[nodiscard]] const Parameters& parameters() const { return p_; }
    [[nodiscard]] std::array<double, kParameters> values() const;
    [[nodiscard]] static LensMap fromValues(std::span<const double> values);

    /// Empty beyond maxTheta().
    [[nodiscard]] std::optional<Direction> directionAt(SensorPoint at) const;
    /// wo above the horizon. Beyond maxTheta() the point lies outside all that directionAt answers.
    [[nodiscard]] SensorPoint pointOf(const Direction& wo) const;
    /// d Omega / dA in steradian per square sensor pixel: sin(theta) theta'(r) / r.
    [[nodiscard]] double solidAnglePerPixel(SensorPoint at) const;
    /// 90 degrees, or less where the polynomial turns back before.
    [[nodiscard]] Radians maxTheta() const { return maxTheta_; }

private:
    struct Polar {
        double r = 0;        // in units of kRadiusScale pixels
        double azimuth = 0;  // as phi + rotation
    };
    [[nodiscard]] Polar polar(SensorPoint at) const;
    [[nodiscard]] double theta(double r) const;
    [[nodiscard]] double thetaSlope(double r) const;

    Parameters p_;
    std::array<double, 3> shape_{};    // exp([a b; b -a]): xx, xy, yy
    std::array<double, 3> inverse_{};  // its inverse
    double maxRadius_ = 0;
    Radians maxTheta_;
};

}  // namespace gonio::proc
