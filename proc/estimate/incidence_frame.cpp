#include "proc/estimate/incidence_frame.h"

#include <cmath>

#include "proc/core/coordinates.h"

namespace gonio::proc {
namespace {

using Eigen::Vector3d;

const double kLowestZ = std::sin(0.5 * kPi / 180);

/// Above the horizon by at least half a degree, at the same azimuth.
Direction lifted(const Vector3d& wo) {
    Vector3d up = wo;
    const double flat = std::hypot(wo.x(), wo.y());
    if (wo.z() < kLowestZ && flat > 0) {
        const double scale = std::sqrt(1 - kLowestZ * kLowestZ) / flat;
        up = {wo.x() * scale, wo.y() * scale, kLowestZ};
    }
    return Direction::fromVector(up).value_or(Direction());
}

Direction byDirectionCosine(const LightView& pair, const Direction& wi) {
    const Vector3d shift = wi.vector() - pair.in.vector();  // of the mirror direction: its negative
    const double x = pair.out.x() - shift.x();
    const double y = pair.out.y() - shift.y();
    const double flat2 = x * x + y * y;
    return lifted({x, y, flat2 < 1 ? std::sqrt(1 - flat2) : 0});
}

Direction byHalfVector(const LightView& pair, const Direction& wi) {
    const Vector3d h = (pair.in.vector() + pair.out.vector()).normalized();
    return lifted(2 * wi.vector().dot(h) * h - wi.vector());
}

}  // namespace

LightView withLightAtZero(const LightView& pair) {
    const Radians turn = -pair.in.phi();
    return {.in = Direction::fromSpherical(pair.in.theta(), Radians(0)),
            .out = pair.out.turned(turn)};
}

LightView viewOf(const Pair<double>& pair) {
    const auto direction = [](const Vec<double>& v) {
        return Direction::fromVector({v.x, v.y, v.z}).value_or(Direction());
    };
    return {.in = direction(pair.in), .out = direction(pair.out)};
}

Direction onSheet(IncidenceFrame frame, const LightView& pair, Radians sheet) {
    const Direction wi = Direction::fromSpherical(sheet, Radians(0));
    switch (frame) {
        case IncidenceFrame::SameDirection: break;
        case IncidenceFrame::SpecularRelative:
            return lifted(fromSpecularRelative(wi, toSpecularRelative(pair)).vector());
        case IncidenceFrame::DirectionCosine: return byDirectionCosine(pair, wi);
        case IncidenceFrame::HalfVector: return byHalfVector(pair, wi);
    }
    return lifted(pair.out.vector());
}

}  // namespace gonio::proc
