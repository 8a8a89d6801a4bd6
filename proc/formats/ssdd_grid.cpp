#include "proc/formats/ssdd_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "proc/formats/far_side.h"
#include "proc/table/spherical_turn.h"

namespace gonio::proc {
namespace {

constexpr double kTurn = 360;

/// The same grid with some of the places on lists 0 and 1 only.
SsddGrid taken(const SsddGrid& grid,
               const std::vector<std::size_t>& incidences,
               const std::vector<std::size_t>& azimuths) {
    SsddGrid out = grid;
    for (std::size_t i = 0; i < 2; ++i) {
        out.list[i].clear();
        for (const std::size_t at : i == 0 ? incidences : azimuths) {
            out.list[i].push_back(grid.list[i][at]);
        }
    }
    out.values.clear();
    for (std::size_t p3 = 0; p3 < grid.list[3].size(); ++p3) {
        for (std::size_t p2 = 0; p2 < grid.list[2].size(); ++p2) {
            for (const std::size_t p1 : azimuths) {
                for (const std::size_t p0 : incidences) {
                    const auto start = grid.values.begin() +
                                       static_cast<std::ptrdiff_t>(grid.index(p0, p1, p2, p3));
                    out.values.insert(out.values.end(),
                                      start,
                                      start + static_cast<std::ptrdiff_t>(grid.channels.size()));
                }
            }
        }
    }
    return out;
}

SphericalBlock blockOf(const SsddGrid& grid, std::size_t p0, std::size_t p1, std::size_t channel) {
    SphericalBlock block{.channel = channel,
                         .lightAzimuthDeg = grid.list[1][p1],
                         .incidenceDeg = grid.list[0][p0],
                         .transmission = grid.transmission,
                         .azimuthDeg = grid.list[3],
                         .thetaDeg = grid.list[2],
                         .f = {}};
    block.f.reserve(grid.list[2].size() * grid.list[3].size());
    for (std::size_t p3 = 0; p3 < grid.list[3].size(); ++p3) {
        for (std::size_t p2 = 0; p2 < grid.list[2].size(); ++p2) {
            block.f.push_back(grid.values[grid.index(p0, p1, p2, p3) + channel]);
        }
    }
    if (block.transmission) turnOver(block);
    return block;
}

/// The block with its azimuths counted from the light's own, the mirror direction at 180.
SphericalBlock turnedWithLight(SphericalBlock block) {
    if (block.lightAzimuthDeg == 0) return block;
    SphericalTable one{
        .channels = {}, .mirrorAzimuthDeg = 180 + block.lightAzimuthDeg, .blocks = {}};
    one.blocks.push_back(std::move(block));
    return std::move(withMirrorAt(std::move(one), 180).blocks.front());
}

}  // namespace

std::vector<std::string> withoutGrazingLight(SsddGrid& grid) {
    std::vector<std::string> warnings;
    std::vector<std::size_t> incidences;
    std::vector<std::size_t> azimuths;
    for (std::size_t i = 0; i < grid.list[0].size(); ++i) {
        if (grid.list[0][i] < 90) incidences.push_back(i);
    }
    for (std::size_t i = 0; i < grid.list[1].size(); ++i) {
        if (i == 0 || grid.list[1][i] < grid.list[1][0] + kTurn - kFinestStepDeg)
            azimuths.push_back(i);
    }
    if (incidences.size() < grid.list[0].size()) {
        warnings.emplace_back("incidence 90 is not read: its light does not reach the surface");
    }
    if (azimuths.size() < grid.list[1].size()) {
        warnings.emplace_back("incoming azimuth 360 is not read: it repeats azimuth 0");
    }
    if (!warnings.empty()) grid = taken(grid, incidences, azimuths);
    return warnings;
}

void appendSpherical(const SsddGrid& grid, SphericalTable& table) {
    table.mirrorAzimuthDeg = 180;
    table.planeSymmetrical = grid.symmetrical;
    for (std::size_t channel = 0; channel < grid.channels.size(); ++channel) {
        for (std::size_t p1 = 0; p1 < grid.list[1].size(); ++p1) {
            for (std::size_t p0 = 0; p0 < grid.list[0].size(); ++p0) {
                table.blocks.push_back(turnedWithLight(blockOf(grid, p0, p1, channel)));
            }
        }
    }
}

Result<SpecularTable> specularTable(const SsddGrid& grid) {
    const auto cannot = [](const std::string& what) {
        return Error{ErrorKind::File, "specular_coordinate_system " + what + " is not read"};
    };
    if (grid.colourModel != "monochrome" && grid.colourModel != "xyz") {
        return cannot("with color model " + grid.colourModel);
    }
    if (std::any_of(grid.list[4].begin(), grid.list[4].end(), [](double v) { return v != 0; })) {
        return cannot("with offsets (PARAM4_LIST)");
    }
    const bool one = grid.list[1].size() == 1;
    if (grid.symmetrical && (!one || grid.list[3].back() > 180)) {
        return cannot("with bilateral_symmetry beyond 180 or of several incoming azimuths");
    }
    SpecularTable table;
    table.kind = grid.transmission ? ScatterKind::Btdf : ScatterKind::Brdf;
    table.colour = grid.colourModel == "xyz" ? TableColour::Xyz : TableColour::Monochrome;
    table.symmetry = grid.symmetrical ? TableSymmetry::PlaneSymmetrical
                     : one            ? TableSymmetry::Asymmetrical
                                      : TableSymmetry::Asymmetrical4D;
    table.incidenceDeg = grid.list[0];
    table.radialDeg = grid.list[2];
    table.azimuthDeg = grid.list[3];
    // Rotation r is the light at azimuth -r.
    std::vector<std::size_t> order(grid.list[1].size());
    std::iota(order.begin(), order.end(), 0U);
    const auto rotation = [&](std::size_t i) {
        return grid.list[1][i] == 0 ? 0 : kTurn - grid.list[1][i];
    };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return rotation(a) < rotation(b);
    });
    table.rotationDeg.clear();
    for (const std::size_t p1 : order) table.rotationDeg.push_back(one ? 0 : rotation(p1));
    table.planes.resize(grid.channels.size());
    for (std::size_t channel = 0; channel < grid.channels.size(); ++channel) {
        TablePlane& plane = table.planes[channel];
        plane.f.reserve(table.nodeCount());
        plane.tis.assign(order.size() * grid.list[0].size(), std::nan(""));
        for (const std::size_t p1 : order) {
            for (std::size_t p0 = 0; p0 < grid.list[0].size(); ++p0) {
                for (std::size_t p3 = 0; p3 < grid.list[3].size(); ++p3) {
                    for (std::size_t p2 = 0; p2 < grid.list[2].size(); ++p2) {
                        plane.f.push_back(grid.values[grid.index(p0, p1, p2, p3) + channel]);
                    }
                }
            }
        }
    }
    return table;
}

}  // namespace gonio::proc
