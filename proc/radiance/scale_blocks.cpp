#include "proc/radiance/scale_blocks.h"

#include <algorithm>
#include <bit>

namespace gonio::proc {

[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] void findLight(
    std::span<const float> above,
    std::span<const float> here,
    std::span<const float> below,
    BlockOfPixels& light) {
    light.fill(0);
    if (here.size() < 3) return;
    const std::size_t width = std::min(here.size() - 2, kBlock);
    for (std::size_t x = 0; x < width; ++x) {
        const float sum = here[x] + here[x + 2] + above[x + 1] + below[x + 1];
        // By its bits: a comparison of floats is not quiet where there is no number.
        constexpr std::int32_t kInfinite = 0x7F800000;
        const auto bits = std::bit_cast<std::int32_t>(sum);
        light[x] = bits > 0 && bits < kInfinite ? static_cast<double>(sum) / 4 : 0;
    }
}

[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] void dropHot(
    const GroupBlock& group, BlockOfPixels& light) {
    if (!group.anyHot) return;
    for (std::size_t x = 0; x < kBlock; ++x) light[x] = group.excess[x] > 0 ? 0 : light[x];
}

[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] NodeBlock asNode(
    const GroupBlock& group,
    const GroupFigures& figures,
    const PixelFigures& pixel,
    const BlockOfPixels& light) {
    const GroupFigures f = figures;
    const double perSecond = pixel.electronsPerDn / f.tau, members = pixel.members;
    NodeBlock node;
    for (std::size_t x = 0; x < kBlock; ++x) {
        const double n = group.count[x];
        const double single = light[x] * f.tau / members + f.floorVariance;
        node.weight[x] = f.tau * f.tau * n / (single + n * f.darkVariance);
        node.rate[x] = group.net[x] * perSecond / std::max(n, 1.0);
    }
    return node;
}

[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] PooledBlock pooled(
    const BlockOfPixels& light, std::span<const NodeBlock* const> nodes) {
    PooledBlock block;
    BlockOfPixels sum{}, seen{};
    for (const NodeBlock* const node : nodes) {
        for (std::size_t x = 0; x < kBlock; ++x) {
            sum[x] += node->weight[x];
            block.mean[x] += node->weight[x] * node->rate[x];
            seen[x] += node->weight[x] > 0 ? 1.0 : 0.0;
        }
    }
    for (std::size_t x = 0; x < kBlock; ++x) {
        block.inverse[x] = 1 / (sum[x] + kTiny);
        block.mean[x] *= block.inverse[x];
        block.light[x] = seen[x] > 1 ? light[x] : 0;
    }
    return block;
}

[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] double pullOf(
    const PooledBlock& block, const NodeBlock& node) {
    BlockOfPixels pull;
    for (std::size_t x = 0; x < kBlock; ++x)
        pull[x] = block.light[x] * node.weight[x] * (node.rate[x] - block.mean[x]);
    return total(pull);
}

[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] PairSums pairSums(
    const PooledBlock& block, const NodeBlock& i, const NodeBlock& j, bool same) {
    const double own = same ? 1 : 0;
    BlockOfPixels h, g;
    for (std::size_t x = 0; x < kBlock; ++x) {
        const double p = i.weight[x] * (own - j.weight[x] * block.inverse[x]);
        h[x] = block.light[x] * block.mean[x] * p;
        g[x] = block.light[x] * block.light[x] * p;
    }
    return {.h = total(h), .g = total(g)};
}

}  // namespace gonio::proc
