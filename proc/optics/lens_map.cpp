#include "proc/optics/lens_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace gonio::proc {
namespace {

constexpr double kSearchRadius = 4;  // far outside any sensor
constexpr double kSearchStep = 1.0 / 256;

/// exp([a b; b -a]) as xx, xy, yy: symmetric, determinant 1.
std::array<double, 3> exponential(double a, double b) {
    const double h = std::hypot(a, b);
    const double c = std::cosh(h);
    const double s = h < 1e-8 ? 1 : std::sinh(h) / h;
    return {c + s * a, s * b, c - s * a};
}

}  // namespace

LensMap::LensMap(const Parameters& parameters)
    : p_(parameters),
      shape_(exponential(parameters.a, parameters.b)),
      inverse_(exponential(-parameters.a, -parameters.b)) {
    // The field ends at the horizon, or where the polynomial stops rising.
    double r = 0;
    while (r < kSearchRadius && thetaSlope(r) > 0 && theta(r) < kPi / 2) r += kSearchStep;
    maxRadius_ = r;
    maxTheta_ = Radians(std::clamp(theta(r), 0.0, kPi / 2));
}

LensMap LensMap::fTheta(SensorPoint centre, double pixelsPerDegree) {
    return LensMap({.centreX = centre.x,
                    .centreY = centre.y,
                    .c1 = kRadiusScale / pixelsPerDegree * (kPi / 180)});
}

std::array<double, LensMap::kParameters> LensMap::values() const {
    return {p_.centreX, p_.centreY, p_.rotation, p_.a, p_.b, p_.c1, p_.c3, p_.c5};
}

LensMap LensMap::fromValues(std::span<const double> v) {
    assert(v.size() == kParameters);
    return LensMap({.centreX = v[0],
                    .centreY = v[1],
                    .rotation = v[2],
                    .a = v[3],
                    .b = v[4],
                    .c1 = v[5],
                    .c3 = v[6],
                    .c5 = v[7]});
}

double LensMap::theta(double r) const {
    const double r2 = r * r;
    return r * (p_.c1 + r2 * (p_.c3 + r2 * p_.c5));
}

double LensMap::thetaSlope(double r) const {
    const double r2 = r * r;
    return p_.c1 + r2 * (3 * p_.c3 + r2 * 5 * p_.c5);
}

LensMap::Polar LensMap::polar(SensorPoint at) const {
    const double dx = at.x - p_.centreX;
    const double dy = at.y - p_.centreY;
    const double u = shape_[0] * dx + shape_[1] * dy;
    const double v = shape_[1] * dx + shape_[2] * dy;
    return {std::hypot(u, v) / kRadiusScale, std::atan2(-v, u)};
}

std::optional<Direction> LensMap::directionAt(SensorPoint at) const {
    const Polar p = polar(at);
    if (p.r >= maxRadius_) return std::nullopt;
    return Direction::fromSpherical(Radians(theta(p.r)), Radians(p.azimuth - p_.rotation));
}

SensorPoint LensMap::pointOf(const Direction& wo) const {
    const double wanted = wo.theta().value();
    double r = maxRadius_;
    if (wanted < maxTheta_.value()) {
        // Newton from the linear guess, kept inside the bracket: theta rises on [0, maxRadius].
        double low = 0;
        double high = maxRadius_;
        r = std::min(wanted / p_.c1, maxRadius_);
        for (int i = 0; i < 50; ++i) {
            const double error = theta(r) - wanted;
            (error > 0 ? high : low) = r;
            double next = r - error / thetaSlope(r);
            if (!(next >= low && next <= high)) next = 0.5 * (low + high);
            if (next == r) break;
            r = next;
        }
    }
    const double azimuth = wo.phi().value() + p_.rotation;
    const double u = kRadiusScale * r * std::cos(azimuth);
    const double v = -kRadiusScale * r * std::sin(azimuth);
    return {p_.centreX + inverse_[0] * u + inverse_[1] * v,
            p_.centreY + inverse_[1] * u + inverse_[2] * v};
}

double LensMap::solidAnglePerPixel(SensorPoint at) const {
    const double r = polar(at).r;
    const double t = theta(r);
    const double perUnit = r < 1e-9 ? p_.c1 * p_.c1 : std::sin(t) * thetaSlope(r) / r;
    return perUnit / (kRadiusScale * kRadiusScale);
}

}  // namespace gonio::proc
