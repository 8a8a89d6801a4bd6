#include "proc/quality/file_totals.h"

#include <cmath>

#include "proc/formats/file_degrees.h"
#include "proc/formats/open.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/block_integral.h"
#include "proc/table/specular_fill.h"
#include "proc/table/specular_integral.h"

namespace gonio::proc {
namespace {

std::string nameOf(const Channel& channel) {
    if (!channel.name.empty()) return channel.name;
    return channel.nanometres ? std::to_string(std::lround(*channel.nanometres)) + " nm" : "";
}

std::vector<TotalFacts> totals(const SampleSet& set, const std::vector<Channel>& channels) {
    std::vector<TotalFacts> all;
    for (const LedTable& led : set.leds) {
        for (const Band band : kBands) {
            const CellSamples& cells = led.bands[index(band)];
            if (cells.size() == 0) continue;
            double total = 0;
            for (std::size_t cell = 0; cell < cells.size(); ++cell) {
                if (!cells.present(cell)) continue;
                total += cells.f[cell] * CellGrid::centre(cell).z() * CellGrid::solidAngle(cell);
            }
            all.push_back({.channel = nameOf(channels[index(band)]),
                           .incidenceDeg = fileDegrees(led.incidence),
                           .lightAzimuthDeg = fileDegrees(-led.rotation),
                           .stated = {},
                           .recomputed = total});
        }
    }
    return all;
}

std::vector<TotalFacts> totals(const SpecularTable& table, const std::vector<Channel>& channels) {
    std::vector<TotalFacts> all;
    for (std::size_t plane = 0; plane < table.planes.size(); ++plane) {
        for (std::size_t r = 0; r < table.rotationDeg.size(); ++r) {
            for (std::size_t i = 0; i < table.incidenceDeg.size(); ++i) {
                const TableNode node{.rotation = r, .incidence = i};
                all.push_back({.channel = nameOf(channels[plane]),
                               .incidenceDeg = table.incidenceDeg[i],
                               .lightAzimuthDeg = fileDegrees(table.pairAt(node).in.phi()),
                               .transmission = table.kind == ScatterKind::Btdf,
                               .stated = table.planes[plane].tis[table.tisIndex(node)],
                               .recomputed = specularIntegral(table, plane, node)});
            }
        }
    }
    return all;
}

std::vector<TotalFacts> totals(const SphericalTable& table, const std::vector<Channel>& channels) {
    std::vector<TotalFacts> all;
    for (const SphericalBlock& block : table.blocks) {
        all.push_back({.channel = nameOf(channels[block.channel]),
                       .incidenceDeg = block.incidenceDeg,
                       .lightAzimuthDeg = block.lightAzimuthDeg,
                       .transmission = block.transmission,
                       .stated = std::isnan(block.tis) ? std::nullopt : std::optional(block.tis),
                       .recomputed = blockIntegral(table, block)});
    }
    return all;
}

/// Patch by patch of the light, its own centre in place of an incidence.
std::vector<TotalFacts> totals(const KlemsTable& table, const std::vector<Channel>& /*channels*/) {
    std::vector<TotalFacts> all;
    for (const KlemsMatrix& matrix : table.matrices) {
        const std::vector<double> shares = table.hemispherical(matrix);
        all.push_back(
            {.channel = matrix.spectrum + (matrix.face == KlemsFace::Front ? " front" : " back"),
             .transmission = matrix.transmission,
             .stated = {},
             .recomputed = shares.front()});
    }
    return all;
}

std::vector<TotalFacts> totals(const BrdfRows& /*rows*/, const std::vector<Channel>& /*channels*/) {
    return {};
}

/// Of what answers everywhere.
template <class Dense>
std::vector<TotalFacts> totals(const Dense& table, const std::vector<Channel>& /*channels*/) {
    std::vector<TotalFacts> all;
    const auto surface = lookupOver({.content = table, .about = {}, .warnings = {}});
    if (!surface) return all;
    for (const double incidence : {0.0, 20.0, 40.0, 60.0}) {
        const Direction wi = Direction::fromSpherical(Radians::fromDegrees(incidence), Radians());
        for (const Band band : kBands) {
            all.push_back({.channel = Channel::of(band).name,
                           .incidenceDeg = incidence,
                           .stated = {},
                           .recomputed = totalScatter(**surface, wi, band)});
        }
    }
    return all;
}

}  // namespace

std::vector<TotalFacts> totalsOf(const BrdfFile& file) {
    const std::vector<Channel> channels = channelsOf(file);
    return std::visit([&](const auto& content) { return totals(content, channels); }, file.content);
}

}  // namespace gonio::proc
