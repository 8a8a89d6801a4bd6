#include "proc/table/specular_lookup.h"

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

/// Where a pair lies on the four axes.
struct TablePlace {
    AxisPlace rotation, incidence, azimuth, radial;

    [[nodiscard]] bool atNode() const {
        return rotation.atNode() && incidence.atNode() && azimuth.atNode() && radial.atNode();
    }
};

std::optional<AxisPlace> placeAzimuth(const SpecularTable& table, double azimuthDeg) {
    if (table.symmetry != TableSymmetry::PlaneSymmetrical) {
        return placeOnCircle(table.azimuthDeg, azimuthDeg);
    }
    return placeOn(table.azimuthDeg, azimuthDeg > 180 ? 360 - azimuthDeg : azimuthDeg);
}

std::optional<TablePlace> placeIn(const SpecularTable& table, const LightView& pair) {
    const SpecularRelative at = toSpecularRelative(pair, pair.in.phi());
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

/// What is wrong with the table; empty when it can be looked up.
std::string complaint(const SpecularTable& table) {
    if (table.colour == TableColour::Xyz) {
        return "table holds CIE XYZ, not the LED bands: an explicit conversion is needed";
    }
    if (table.kind == ScatterKind::Btdf) return "table holds a BTDF: only BRDF can be looked up";
    if (table.nodeCount() == 0) return "table has no nodes";
    if (table.planes.size() != 1 || table.planes[0].f.size() != table.nodeCount()) {
        return "table has " + std::to_string(table.planes.empty() ? 0 : table.planes[0].f.size()) +
               " values, its axes want " + std::to_string(table.nodeCount());
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

SpecularLookup::SpecularLookup(SpecularTable table)
    : table_(std::move(table)), f_(table_.nodeCount(), kNan) {
    for (TableNode n; n.rotation < table_.rotationDeg.size(); ++n.rotation) {
        for (n.incidence = 0; n.incidence < table_.incidenceDeg.size(); ++n.incidence) {
            for (n.azimuth = 0; n.azimuth < table_.azimuthDeg.size(); ++n.azimuth) {
                for (n.radial = 0; n.radial < table_.radialDeg.size(); ++n.radial) {
                    const std::size_t i = table_.index(n);
                    if (table_.hasData(0, n)) f_[i] = table_.planes[0].f[i];
                }
            }
        }
    }
}

Answer SpecularLookup::answer(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    }
    const auto place = placeIn(table_, pair);
    if (!place) return Answer::none({}, Source::Interpolated);
    const double f = between(place->rotation, [&](std::size_t rotation) {
        return between(place->incidence, [&](std::size_t incidence) {
            return between(place->azimuth, [&](std::size_t azimuth) {
                return between(place->radial, [&](std::size_t radial) {
                    return f_[table_.index({rotation, incidence, azimuth, radial})];
                });
            });
        });
    });
    const bool node = place->atNode();
    const Source source = node ? Source::Measured : Source::Interpolated;
    if (std::isnan(f)) return Answer::none({}, source);
    Answer answer;
    answer.f = LedBands::all(f);
    answer.flags.set(node ? Flag::Measured : Flag::Interpolated);
    answer.source = source;
    return answer;
}

}  // namespace gonio::proc
