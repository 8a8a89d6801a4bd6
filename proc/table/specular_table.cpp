#include "proc/table/specular_table.h"

#include <algorithm>
#include <cmath>

#include "proc/core/coordinates.h"
#include "proc/table/axis.h"

namespace gonio::proc {
namespace {

/// cos(90 deg) is 6e-17 in double; a node this close to the horizon is on it.
constexpr double kHorizon = 1e-12;

}  // namespace

std::size_t SpecularTable::nodeCount() const {
    return rotationDeg.size() * incidenceDeg.size() * azimuthDeg.size() * radialDeg.size();
}

std::size_t SpecularTable::tisIndex(TableNode node) const {
    return node.rotation * incidenceDeg.size() + node.incidence;
}

std::size_t SpecularTable::index(TableNode node) const {
    return (tisIndex(node) * azimuthDeg.size() + node.azimuth) * radialDeg.size() + node.radial;
}

LightView SpecularTable::pairAt(TableNode node) const {
    const Radians phiIn = -Radians::fromDegrees(rotationDeg[node.rotation]);
    const Radians theta = Radians::fromDegrees(incidenceDeg[node.incidence]);
    const Direction wi = Direction::fromSpherical(theta, phiIn);
    const SpecularRelative at{.radial = Radians::fromDegrees(radialDeg[node.radial]),
                              .azimuth = Radians::fromDegrees(azimuthDeg[node.azimuth])};
    const Direction wo = fromSpecularRelative(wi, at, phiIn);
    return {.in = wi, .out = kind == ScatterKind::Btdf ? acrossSurface(wo) : wo};
}

bool SpecularTable::canHoldData(TableNode node) const {
    // z of the node, by the angles alone: cos r cos t + sin r cos a sin t.
    const Radians r = Radians::fromDegrees(radialDeg[node.radial]);
    const Radians a = Radians::fromDegrees(azimuthDeg[node.azimuth]);
    const Radians t = Radians::fromDegrees(incidenceDeg[node.incidence]);
    return cos(r) * cos(t) + sin(r) * cos(a) * sin(t) > kHorizon;
}

bool SpecularTable::hasData(std::size_t plane, TableNode node) const {
    const double f = planes[plane].f[index(node)];
    return f != 0 && !std::isnan(f) && canHoldData(node);
}

bool SpecularTable::hasData(TableNode node) const {
    for (std::size_t plane = 0; plane < planes.size(); ++plane) {
        if (!hasData(plane, node)) return false;
    }
    return !planes.empty();
}

LedBands SpecularTable::bandsAt(TableNode node) const {
    LedBands f;
    for (std::size_t band = 0; band < 3; ++band) {
        f.value[band] = planes[std::min(band, planes.size() - 1)].f[index(node)];
    }
    return f;
}

bool SpecularTable::hasOpenPole() const {
    return radialDeg.size() > 1 && endsInACell(radialDeg[0], radialDeg[1] - radialDeg[0]);
}

bool SpecularTable::repeatsDirection(TableNode node) const {
    const bool pole = radialDeg[node.radial] == 0 && node.azimuth > 0;
    return pole || azimuthDeg[node.azimuth] - azimuthDeg.front() >= 360;
}

}  // namespace gonio::proc
