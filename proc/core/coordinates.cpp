#include "proc/core/coordinates.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace gonio {
namespace {

/// Unit axes about the mirror direction: s itself, u toward the normal, v = s x u.
struct SpecularFrame {
    Eigen::Vector3d s, u, v;
};

// With s = (-sin t cos p, -sin t sin p, cos t): u = (cos t cos p, cos t sin p, sin t), which has no
// 0/0 at the pole; v = s x u = (-sin p... ) has length 1 by construction.
SpecularFrame specularFrame(const Direction& wi, Radians phiIn) {
    const double sinTheta = std::hypot(wi.x(), wi.y());
    const bool pole = sinTheta == 0;
    const double cosPhi = pole ? cos(phiIn) : wi.x() / sinTheta;
    const double sinPhi = pole ? sin(phiIn) : wi.y() / sinTheta;
    SpecularFrame frame;
    frame.s = {-wi.x(), -wi.y(), wi.z()};
    frame.u = {wi.z() * cosPhi, wi.z() * sinPhi, sinTheta};
    frame.v = frame.s.cross(frame.u);
    return frame;
}

Radians wrapped(double phi) {
    if (phi >= 0) return Radians(phi);
    const double up = phi + 2 * kPi;
    return Radians(up < 2 * kPi ? up : 0.0);
}

}  // namespace

SpecularRelative toSpecularRelative(const LightView& pair, Radians phiIn) {
    const SpecularFrame frame = specularFrame(pair.in, phiIn);
    // Differences from s keep every digit of a small radial angle.
    const Eigen::Vector3d d = pair.out.vector() - frame.s;
    const double alongU = d.dot(frame.u);
    const double alongV = d.dot(frame.v);
    const double chord = d.norm();
    const double sum = (pair.out.vector() + frame.s).norm();
    const bool pole = alongU == 0 && alongV == 0;
    return {.radial = Radians(2 * std::atan2(chord, sum)),
            .azimuth = pole ? Radians(0) : wrapped(std::atan2(alongV, alongU))};
}

Direction fromSpecularRelative(const Direction& wi, const SpecularRelative& at, Radians phiIn) {
    const SpecularFrame frame = specularFrame(wi, phiIn);
    const Eigen::Vector3d side = cos(at.azimuth) * frame.u + sin(at.azimuth) * frame.v;
    return *Direction::fromVector(cos(at.radial) * frame.s + sin(at.radial) * side);
}

std::optional<HalfDifference> toHalfDifference(const LightView& pair) {
    const Eigen::Vector3d sum = pair.in.vector() + pair.out.vector();
    constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();
    if (sum.norm() <= kRounding) return std::nullopt;
    const Direction h = *Direction::fromVector(sum);
    const double sinHalf = std::hypot(h.x(), h.y());
    const double cosPhi = sinHalf == 0 ? 1 : h.x() / sinHalf;
    const double sinPhi = sinHalf == 0 ? 0 : h.y() / sinHalf;
    // The axes of the turned frame, written out: x' = Rz Ry x, y' = Rz y.
    const Eigen::Vector3d xAxis(h.z() * cosPhi, h.z() * sinPhi, -sinHalf);
    const Eigen::Vector3d yAxis(-sinPhi, cosPhi, 0);
    const Eigen::Vector3d half = (pair.in.vector() - pair.out.vector()) / 2;  // no part along h
    const double dx = half.dot(xAxis);
    const double dy = half.dot(yAxis);
    const double cosDiff = sum.norm() / 2;
    return HalfDifference{.thetaHalf = h.theta(),
                          .phiHalf = h.phi(),
                          .thetaDiff = Radians(std::atan2(half.norm(), cosDiff)),
                          .phiDiff = dx == 0 && dy == 0 ? Radians(0) : wrapped(std::atan2(dy, dx))};
}

LightView fromHalfDifference(const HalfDifference& at) {
    const Direction h = Direction::fromSpherical(at.thetaHalf, at.phiHalf);
    const double cosPhi = cos(at.phiHalf);
    const double sinPhi = sin(at.phiHalf);
    const Eigen::Vector3d xAxis(
        cos(at.thetaHalf) * cosPhi, cos(at.thetaHalf) * sinPhi, -sin(at.thetaHalf));
    const Eigen::Vector3d yAxis(-sinPhi, cosPhi, 0);
    const Eigen::Vector3d side =
        sin(at.thetaDiff) * (cos(at.phiDiff) * xAxis + sin(at.phiDiff) * yAxis);
    const Eigen::Vector3d along = cos(at.thetaDiff) * h.vector();
    return {.in = *Direction::fromVector(along + side),
            .out = *Direction::fromVector(along - side)};
}

}  // namespace gonio
