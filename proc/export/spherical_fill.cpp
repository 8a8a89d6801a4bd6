#include "proc/export/spherical_fill.h"

#include <cmath>
#include <limits>

#include "proc/core/parallel.h"

namespace gonio::proc {
namespace {

constexpr double kHorizon = 1e-12;  // cos(90 deg) is 6e-17 in double
/// A node on the horizon holds the limit: what is answered this far from it, degrees.
constexpr double kNudgeDeg = 1e-6;

struct BlockCounts {
    std::size_t nodes = 0, unanswered = 0, uncertain = 0, extrapolated = 0;
};

Band bandOf(const Channel& channel, Band other) {
    for (const Band band : kBands) {
        if (channel.name == Channel::of(band).name) return band;
    }
    return other;
}

/// The pair of a node, or beside the horizon of one that lies on it.
LightView askedPair(const SphericalTable& table,
                    const SphericalBlock& block,
                    std::size_t azimuth,
                    std::size_t theta) {
    LightView pair = table.pairAt(block, azimuth, theta);
    if (std::abs(pair.out.z()) > kHorizon) return pair;
    const double asked = block.transmission ? 90 + kNudgeDeg : 90 - kNudgeDeg;
    pair.out = Direction::fromSpherical(Radians::fromDegrees(asked), pair.out.phi());
    return pair;
}

BlockCounts fillBlock(const Scatterer& from,
                      const SphericalTable& table,
                      SphericalBlock& block,
                      Band band) {
    BlockCounts counts;
    block.f.assign(block.azimuthDeg.size() * block.thetaDeg.size(),
                   std::numeric_limits<double>::quiet_NaN());
    for (std::size_t azimuth = 0; azimuth < block.azimuthDeg.size(); ++azimuth) {
        for (std::size_t theta = 0; theta < block.thetaDeg.size(); ++theta) {
            const LightView pair = askedPair(table, block, azimuth, theta);
            if ((block.transmission ? -pair.out.z() : pair.out.z()) <= kHorizon) continue;
            ++counts.nodes;
            const Answer answer = from.answer(pair);
            const double f = answer.f[band];
            if (std::isnan(f)) {
                ++counts.unanswered;
                continue;
            }
            block.f[block.index(azimuth, theta)] = f;
            if (answer.u(band)) ++counts.uncertain;
            if (answer.flags.has(Flag::Extrapolated)) ++counts.extrapolated;
        }
    }
    return counts;
}

}  // namespace

FilledSpherical fillSpherical(const Scatterer& from, SphericalTable grid, Band otherChannels) {
    FilledSpherical filled{.table = std::move(grid)};
    SphericalTable& table = filled.table;
    std::vector<BlockCounts> counts(table.blocks.size());
    parallelFor(table.blocks.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            SphericalBlock& block = table.blocks[i];
            const Band band = bandOf(table.channels[block.channel], otherChannels);
            counts[i] = fillBlock(from, table, block, band);
        }
    });
    for (const BlockCounts& of : counts) {
        filled.nodes += of.nodes;
        filled.unanswered += of.unanswered;
        filled.uncertain += of.uncertain;
        filled.extrapolated += of.extrapolated;
    }
    return filled;
}

}  // namespace gonio::proc
