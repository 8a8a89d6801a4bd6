#include "proc/table/specular_lookup.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/core/coordinates.h"
#include "proc/table/axis.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// (1 - t) low + t high; a node of no weight is not asked, so that its NaN cannot answer.
template <class ValueAt>
double between(const AxisPlace& place, const ValueAt& valueAt) {
    const double low = valueAt(place.low);
    return place.atNode() ? low : (1 - place.t) * low + place.t * valueAt(place.high);
}

std::optional<AxisPlace> placeAzimuth(const SpecularTable& table, double azimuthDeg) {
    if (table.symmetry != TableSymmetry::PlaneSymmetrical) {
        return placeOnCircle(table.azimuthDeg, azimuthDeg);
    }
    return placeOn(table.azimuthDeg, azimuthDeg > 180 ? 360 - azimuthDeg : azimuthDeg);
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
    const auto radial = placeOn(table.radialDeg, at.radial.degrees());
    const auto rotation = table.rotationDeg.size() == 1
                              ? AxisPlace{}
                              : placeOnCircle(table.rotationDeg, -pair.in.phi().degrees());
    if (!incidence || !azimuth || !radial || !rotation) return std::nullopt;
    return TablePlace{*rotation, *incidence, *azimuth, *radial};
}

double SpecularLookup::valueAt(std::size_t plane, const TablePlace& place) const {
    const std::size_t first = plane * table_.nodeCount();
    return between(place.rotation, [&](std::size_t rotation) {
        return between(place.incidence, [&](std::size_t incidence) {
            return between(place.azimuth, [&](std::size_t azimuth) {
                return between(place.radial, [&](std::size_t radial) {
                    return f_[first + table_.index({rotation, incidence, azimuth, radial})];
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
