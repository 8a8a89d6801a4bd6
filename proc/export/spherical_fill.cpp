#include "proc/export/spherical_fill.h"

#include <cmath>
#include <limits>

#include "proc/core/parallel.h"
#include "proc/table/specular_fill.h"

namespace gonio::proc {
namespace {

/// Of one light direction, a block for each channel.
std::vector<SphericalBlock> emptyBlocks(const SphericalGrid& grid,
                                        std::size_t channels,
                                        const SphericalBlock& light) {
    std::vector<SphericalBlock> blocks(channels, light);
    for (std::size_t c = 0; c < channels; ++c) {
        blocks[c].channel = c;
        blocks[c].azimuthDeg = grid.azimuthDeg;
        blocks[c].thetaDeg = grid.thetaDeg;
        blocks[c].f.assign(grid.azimuthDeg.size() * grid.thetaDeg.size(),
                           std::numeric_limits<double>::quiet_NaN());
    }
    return blocks;
}

struct Counts {
    std::size_t nodes = 0, unanswered = 0, extrapolated = 0;
};

/// Asks at the nodes of one azimuth.
Counts askRow(const Scatterer& from,
              const SphericalTable& table,
              std::vector<SphericalBlock>& blocks,
              std::size_t azimuth) {
    Counts counts;
    for (std::size_t theta = 0; theta < blocks[0].thetaDeg.size(); ++theta) {
        const LightView pair = table.pairAt(blocks[0], azimuth, theta);
        if (blocks[0].thetaDeg[theta] >= 90) continue;
        const Answer answer = from.answer(pair);
        for (SphericalBlock& block : blocks) {
            const double f = answer.f.value[block.channel];
            ++counts.nodes;
            if (std::isnan(f)) ++counts.unanswered;
            if (!std::isnan(f) && answer.flags.has(Flag::Extrapolated)) ++counts.extrapolated;
            block.f[block.index(azimuth, theta)] = f;
        }
    }
    return counts;
}

}  // namespace

FilledSpherical fillSpherical(const Scatterer& from,
                              const SphericalGrid& grid,
                              const std::vector<Channel>& channels) {
    FilledSpherical filled;
    filled.table.channels = channels;
    filled.table.mirrorAzimuthDeg = grid.mirrorAzimuthDeg;
    filled.table.planeSymmetrical = grid.planeSymmetrical;
    std::vector<std::vector<SphericalBlock>> byChannel(channels.size());
    for (const double lightAzimuth : grid.lightAzimuthDeg) {
        for (const double incidence : grid.incidenceDeg) {
            SphericalBlock light;
            light.lightAzimuthDeg = lightAzimuth;
            light.incidenceDeg = incidence;
            auto blocks = emptyBlocks(grid, channels.size(), light);
            std::vector<Counts> counts(grid.azimuthDeg.size());
            parallelFor(grid.azimuthDeg.size(), [&](IndexRange range) {
                for (std::size_t a = range.begin; a < range.end; ++a) {
                    counts[a] = askRow(from, filled.table, blocks, a);
                }
            });
            for (const Counts& row : counts) {
                filled.nodes += row.nodes;
                filled.unanswered += row.unanswered;
                filled.extrapolated += row.extrapolated;
            }
            const Direction wi = filled.table.pairAt(blocks[0], 0, 0).in;
            for (SphericalBlock& block : blocks) {
                if (grid.tis) block.tis = totalScatter(from, wi, kBands[block.channel]);
                byChannel[block.channel].push_back(std::move(block));
            }
        }
    }
    for (auto& blocks : byChannel) {
        for (SphericalBlock& block : blocks) filled.table.blocks.push_back(std::move(block));
    }
    return filled;
}

}  // namespace gonio::proc
