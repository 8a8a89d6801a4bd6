#include "sim/optics.h"

#include <algorithm>
#include <cmath>

#include "sim/random.h"

namespace gonio::sim {
namespace {

constexpr double kFieldStop = 76 * kPi / 180;
constexpr double kPixelsPerDegree = 6.6;

std::uint64_t keyOf(const std::string& serial) {
    std::uint64_t key = 0x6C656E73;  // the lens's own stream
    for (char c : serial) key = mixed(key, static_cast<unsigned char>(c));
    return key;
}

}  // namespace

Optics::Optics(const std::string& serial, ImagePoint middle) {
    const std::uint64_t key = keyOf(serial);
    const auto draw = [&](std::uint64_t i) { return 2 * uniform(key, i) - 1; };
    const double offset = 7.5 * std::sqrt(uniform(key, 0));
    const double toward = kPi * draw(1);
    centre_ = {middle.x + offset * std::cos(toward), middle.y + offset * std::sin(toward)};
    rotation_ = draw(2) * kPi / 180;
    stretch_ = 1 + 0.003 * draw(3);
    ellipseAxis_ = kPi * draw(4);
    scale_ = kPixelsPerDegree * 180 / kPi * (1 + 0.002 * draw(5));
    mixture_ = 0.05 * draw(6);
    falloff_ = 0.12 + 0.05 * draw(7);
}

double Optics::radius(double theta) const {
    return scale_ * ((1 - mixture_) * theta + mixture_ * 2 * std::sin(theta / 2));
}

double Optics::radiusSlope(double theta) const {
    return scale_ * ((1 - mixture_) + mixture_ * std::cos(theta / 2));
}

std::optional<Direction> Optics::directionAt(ImagePoint at) const {
    // Undo, in turn: centre, ellipse, rotation, radial mapping.
    const double dx = at.x - centre_.x;
    const double dy = at.y - centre_.y;
    const double c = std::cos(ellipseAxis_);
    const double s = std::sin(ellipseAxis_);
    const double along = (c * dx + s * dy) / stretch_;
    const double across = (-s * dx + c * dy) * stretch_;
    const double u = c * along - s * across;
    const double v = s * along + c * across;
    const double r = std::hypot(u, v);
    double theta = r / scale_;
    // Newton doubles the digits, and the mapping is nearly linear: after a step below 1e-9 radians
    // theta is exact. Two or three steps within the field.
    double step = 1;
    for (int i = 0; i < 6 && std::abs(step) > 1e-9; ++i) {
        step = (radius(theta) - r) / radiusSlope(theta);
        theta -= step;
    }
    if (theta > kFieldStop) return std::nullopt;
    return Direction::fromSpherical(Radians(theta), Radians(std::atan2(-v, u) - rotation_));
}

ImagePoint Optics::pixelOf(const Direction& wo) const {
    const double r = radius(wo.theta().value());
    const double azimuth = wo.phi().value() + rotation_;
    const double u = r * std::cos(azimuth);
    const double v = -r * std::sin(azimuth);
    const double c = std::cos(ellipseAxis_);
    const double s = std::sin(ellipseAxis_);
    const double along = (c * u + s * v) * stretch_;
    const double across = (-s * u + c * v) / stretch_;
    return {centre_.x + c * along - s * across, centre_.y + s * along + c * across};
}

double Optics::relativeSolidAngle(const Direction& wo) const {
    const double theta = wo.theta().value();
    // d Omega / dA = sin(theta) / (r r'), at the middle 1 / r'(0)^2; the ellipse keeps areas.
    const double middle = radiusSlope(0);
    if (theta < 1e-6) return 1;
    return std::sin(theta) * middle * middle / (radius(theta) * radiusSlope(theta));
}

double Optics::vignetting(const Direction& wo) const {
    const double t = wo.theta().value() / kFieldStop;
    return 1 - falloff_ * t * t;
}

}  // namespace gonio::sim
