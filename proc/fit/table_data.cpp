// Rows of a specular-relative table: its directions, each once.

#include <cmath>

#include "proc/fit/data_maker.h"

namespace gonio::proc {
namespace {

/// Half of the way to the neighbours on either side; at an end of the list to the one there is.
double halfSteps(const std::vector<double>& values, std::size_t at) {
    double width = 0;
    if (at > 0) width += (values[at] - values[at - 1]) / 2;
    if (at + 1 < values.size()) width += (values[at + 1] - values[at]) / 2;
    return width;
}

/// What a direction stands for about the mirror direction, in square degrees or, at the pole, as
/// much; relative to others of the table is all that counts. Steps of a lone node are 1 degree.
double solidAngleOf(const SpecularTable& table, const TableNode& node) {
    const std::vector<double>& azimuths = table.azimuthDeg;
    const double sweep = azimuths.back() - azimuths.front();
    double azimuth = azimuths.size() > 1 ? halfSteps(azimuths, node.azimuth) : 1;
    if (node.azimuth == 0 && sweep >= 360) azimuth += halfSteps(azimuths, azimuths.size() - 1);
    const double radius = Radians::fromDegrees(table.radialDeg[node.radial]).value();
    const double radial = table.radialDeg.size() > 1 ? halfSteps(table.radialDeg, node.radial) : 1;
    if (radius > 0) return std::sin(radius) * radial * azimuth;
    // The cap: 1 - cos of its edge, over the whole sweep.
    const double edge = Radians::fromDegrees(radial).value();
    return (1 - std::cos(edge)) * (180 / kPi) * (sweep > 0 ? sweep : 1);
}

}  // namespace

Result<BrdfData> fitDataOf(const SpecularTable& table, const DataOptions& options) {
    if (table.kind == ScatterKind::Btdf) {
        return Error{ErrorKind::Usage, "fit: a table of transmission; one of reflection is wanted"};
    }
    if (table.colour == TableColour::Xyz) {
        return Error{ErrorKind::Usage, "fit: a table in XYZ; one of the LED bands is wanted"};
    }
    DataMaker maker(options);
    const bool three = table.colour == TableColour::LedBands;
    maker.data().bands = three ? BandCount::Three : BandCount::One;
    maker.data().uKnown = false;
    for (std::size_t i = 0; i < table.incidenceDeg.size(); ++i) {
        maker.data().incidences.push_back(Radians::fromDegrees(table.incidenceDeg[i]));
        for (std::size_t a = 0; a < table.azimuthDeg.size(); ++a) {
            for (std::size_t r = 0; r < table.radialDeg.size(); ++r) {
                const TableNode node{.rotation = 0, .incidence = i, .azimuth = a, .radial = r};
                if (table.repeatsDirection(node)) continue;
                const LightView pair = table.pairAt(node);
                if (!table.hasData(node) || !pair.in.aboveHorizon()) {
                    maker.leaveOut();
                    continue;
                }
                FitRow& row = maker.add(pair);
                row.group = static_cast<std::uint16_t>(i);
                for (std::size_t plane = 0; plane < table.planes.size(); ++plane) {
                    row.f[plane] = table.planes[plane].f[table.index(node)];
                }
                row.solidAngle = solidAngleOf(table, node);
            }
        }
    }
    return std::move(maker).finished();
}

}  // namespace gonio::proc
