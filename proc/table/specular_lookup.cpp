#include "proc/table/specular_lookup.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/core/coordinates.h"
#include "proc/table/axis.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kPole = std::numeric_limits<std::size_t>::max();  ///< of radials

/// A radial between the pole, as node `high` of the place, and the first node, as `low`.
std::optional<AxisPlace> placeRadial(const SpecularTable& table, double radialDeg) {
    if (const auto place = placeOn(table.radialDeg, radialDeg)) return place;
    if (!table.hasOpenPole() || radialDeg > table.radialDeg.front()) return std::nullopt;
    return AxisPlace{0, kPole, 1 - radialDeg / table.radialDeg.front()};
}

std::optional<AxisPlace> placeAzimuth(const SpecularTable& table, double azimuthDeg) {
    if (table.symmetry != TableSymmetry::PlaneSymmetrical) {
        return placeOnCircle(table.azimuthDeg, azimuthDeg);
    }
    const std::vector<double>& axis = table.azimuthDeg;
    double at = azimuthDeg > 180 ? 360 - azimuthDeg : azimuthDeg;
    // Between the mirror plane and the centre of the cell beside it both sides are the same.
    if (axis.size() > 1 && at < axis[0] && endsInACell(axis[0], axis[1] - axis[0])) at = axis[0];
    const std::size_t last = axis.size() - 1;
    if (axis.size() > 1 && at > axis[last] &&
        endsInACell(180 - axis[last], axis[last] - axis[last - 1])) {
        at = axis[last];
    }
    return placeOn(axis, at);
}

/// What is wrong with the table; empty when it can be looked up.
std::string complaint(const SpecularTable& table) {
    if (table.colour == TableColour::Xyz) {
        return "table holds CIE XYZ, not the LED bands: an explicit conversion is needed";
    }
    if (table.nodeCount() == 0) return "table has no nodes";
    const std::size_t wanted = table.colour == TableColour::LedBands ? 3 : 1;
    if (table.planes.size() != wanted) {
        return "table has " + std::to_string(table.planes.size()) + " planes, wanted " +
               std::to_string(wanted);
    }
    for (const TablePlane& plane : table.planes) {
        if (plane.f.size() != table.nodeCount()) {
            return "table has " + std::to_string(plane.f.size()) + " values, its axes want " +
                   std::to_string(table.nodeCount());
        }
    }
    return "";
}

}  // namespace

Result<SpecularLookup> SpecularLookup::over(SpecularTable table) {
    if (std::string wrong = complaint(table); !wrong.empty()) {
        return Error{ErrorKind::File, "look-up: " + wrong};
    }
    return SpecularLookup(std::move(table));
}

/// Where a pair lies on the four axes.
struct SpecularLookup::TablePlace {
    AxisPlace rotation, incidence, azimuth, radial;

    [[nodiscard]] bool atNode() const {
        return rotation.atNode() && incidence.atNode() && azimuth.atNode() && radial.atNode();
    }
};

SpecularLookup::SpecularLookup(SpecularTable table)
    : table_(std::move(table)),
      planes_(table_.planes.size()),
      f_(planes_ * table_.nodeCount(), kNan) {
    for (std::size_t plane = 0; plane < planes_; ++plane) {
        const std::size_t first = plane * table_.nodeCount();
        for (TableNode n; n.rotation < table_.rotationDeg.size(); ++n.rotation) {
            for (n.incidence = 0; n.incidence < table_.incidenceDeg.size(); ++n.incidence) {
                for (n.azimuth = 0; n.azimuth < table_.azimuthDeg.size(); ++n.azimuth) {
                    for (n.radial = 0; n.radial < table_.radialDeg.size(); ++n.radial) {
                        const std::size_t i = table_.index(n);
                        if (table_.hasData(plane, n)) f_[first + i] = table_.planes[plane].f[i];
                    }
                }
            }
        }
    }
}

std::optional<SpecularLookup::TablePlace> SpecularLookup::placeIn(const SpecularTable& table,
                                                                  const LightView& pair) {
    const bool through = table.kind == ScatterKind::Btdf;
    const LightView reflected{.in = pair.in, .out = through ? acrossSurface(pair.out) : pair.out};
    const SpecularRelative at = toSpecularRelative(reflected, pair.in.phi());
    const double incidenceDeg = std::max(pair.in.theta().degrees(), table.incidenceDeg.front());
    const auto incidence = placeOn(table.incidenceDeg, incidenceDeg);
    const auto azimuth = placeAzimuth(table, at.azimuth.degrees());
    const auto radial = placeRadial(table, at.radial.degrees());
    const auto rotation = table.rotationDeg.size() == 1
                              ? AxisPlace{}
                              : placeOnCircle(table.rotationDeg, -pair.in.phi().degrees());
    if (!incidence || !azimuth || !radial || !rotation) return std::nullopt;
    return TablePlace{*rotation, *incidence, *azimuth, *radial};
}

double SpecularLookup::poleAt(std::size_t plane, TableNode node) const {
    double sum = 0;
    node.radial = 0;
    for (node.azimuth = 0; node.azimuth < table_.azimuthDeg.size(); ++node.azimuth) {
        sum += f_[plane * table_.nodeCount() + table_.index(node)];
    }
    return sum / static_cast<double>(table_.azimuthDeg.size());
}

double SpecularLookup::valueAt(std::size_t plane, const TablePlace& place) const {
    const std::size_t first = plane * table_.nodeCount();
    return between(place.rotation, [&](std::size_t rotation) {
        return between(place.incidence, [&](std::size_t incidence) {
            return between(place.azimuth, [&](std::size_t azimuth) {
                return between(place.radial, [&](std::size_t radial) {
                    const TableNode node{rotation, incidence, azimuth, radial};
                    return radial == kPole ? poleAt(plane, node) : f_[first + table_.index(node)];
                });
            });
        });
    });
}

Answer SpecularLookup::answer(const LightView& pair) const {
    const bool through = table_.kind == ScatterKind::Btdf;
    if (!pair.in.aboveHorizon() || (through ? pair.out.z() >= 0 : !pair.out.aboveHorizon())) {
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    }
    const auto place = placeIn(table_, pair);
    if (!place) return Answer::none({}, Source::Interpolated);
    const bool node = place->atNode();
    Answer answer = Answer::none({}, node ? Source::Measured : Source::Interpolated);
    answer.f = LedBands::all(valueAt(0, *place));
    for (std::size_t plane = 1; plane < planes_; ++plane) {
        answer.f.value[plane] = valueAt(plane, *place);
    }
    const auto missing = [](double f) { return std::isnan(f); };
    const bool none = std::all_of(answer.f.value.begin(), answer.f.value.end(), missing);
    if (!none) answer.flags.set(node ? Flag::Measured : Flag::Interpolated);
    return answer;
}

}  // namespace gonio::proc
