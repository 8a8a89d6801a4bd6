#include "proc/radiance/merge_blocks.h"

#include <algorithm>
#include <limits>

namespace gonio::proc {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// At most 255.
std::uint8_t capped(double count) {
    return static_cast<std::uint8_t>(static_cast<int>(std::min(count, 255.0)));
}

}  // namespace

[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] void addUsable(
    std::span<const std::uint16_t> row,
    std::span<const std::uint8_t> usable,
    std::span<std::uint32_t> tallies) {
    constexpr std::uint32_t kOne = 1U << kSumBits;
    for (std::size_t x = 0; x < tallies.size(); ++x) {
        const std::uint32_t all = 0U - usable[x];  // every bit set where it is usable
        tallies[x] += all & (kOne | row[x]);
    }
}

[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] void unpackTallies(
    std::span<const std::uint32_t> tallies, std::span<const float> dark, GroupBlock& block) {
    const std::size_t width = tallies.size();
    for (std::size_t x = 0; x < width; ++x) {
        const auto n = static_cast<double>(static_cast<int>(tallies[x] >> kSumBits));
        const auto sum = static_cast<double>(static_cast<int>(tallies[x] & kLargestSum));
        block.count[x] = n;
        block.net[x] = sum - n * static_cast<double>(dark[x]);
    }
    std::fill(block.count.begin() + static_cast<std::ptrdiff_t>(width), block.count.end(), 0.0);
    std::fill(block.net.begin() + static_cast<std::ptrdiff_t>(width), block.net.end(), 0.0);
}

[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] void straighten(
    const Bend& bend, std::span<const float> dark, GroupBlock& block) {
    BlockOfPixels seen, dim;  // readings of the light and of the dark, in units of the range
    const double slope = bend.coefficients.front(), scale = 1 / bend.range;
    const BlockOfPixels& net = block.net;
    for (std::size_t x = 0; x < kBlock; ++x) seen[x] = net[x];
    if (!block.single) {  // a quotient takes as long as the rest
        for (std::size_t x = 0; x < kBlock; ++x) seen[x] /= std::max(block.count[x], 1.0);
    }
    for (std::size_t x = 0; x < dark.size(); ++x) {
        const double base = static_cast<double>(dark[x]) - bend.black;
        dim[x] = base * scale;
        seen[x] = (seen[x] + base) * scale;
    }
    std::fill(seen.begin() + static_cast<std::ptrdiff_t>(dark.size()), seen.end(), 0.0);
    std::fill(dim.begin() + static_cast<std::ptrdiff_t>(dark.size()), dim.end(), 0.0);
    for (BlockOfPixels* const of : {&seen, &dim}) {
        BlockOfPixels sum{}, m;
        for (std::size_t x = 0; x < kBlock; ++x) m[x] = std::clamp((*of)[x], 0.0, 1.0);
        for (std::size_t a = bend.coefficients.size(); a > 0; --a) {
            const double next = bend.coefficients[a - 1];
            for (std::size_t x = 0; x < kBlock; ++x) sum[x] = (sum[x] + next) * m[x];
        }
        for (std::size_t x = 0; x < kBlock; ++x)
            (*of)[x] = bend.range * (sum[x] + slope * std::min((*of)[x], 0.0));
    }
    for (std::size_t x = 0; x < kBlock; ++x) block.net[x] += block.count[x] * (seen[x] - dim[x]);
}

[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] void pool(
    const GroupBlock& group, double tau, MergeBlock& block) {
    for (std::size_t x = 0; x < kBlock; ++x) {
        block.net[x] += group.net[x];
        block.count[x] += group.count[x];
        block.tau[x] += tau * group.count[x];
    }
}

[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] void findShot(
    double electronsPerDn, double members, MergeBlock& block) {
    const double scale = electronsPerDn / members;
    for (std::size_t x = 0; x < kBlock; ++x) {
        block.shot[x] = std::max(scale * block.net[x] / (block.tau[x] + kTiny), 0.0);
    }
}

[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] void weigh(
    const GroupBlock& group,
    const GroupFigures& figures,
    double electronsPerDn,
    MergeBlock& block) {
    const GroupFigures f = figures;
    const BlockOfPixels& excess = group.anyHot ? group.excess : kNoExcess;
    BlockOfPixels squares;
    // With n samples of sum e: variance of the mean v = single / n + dark, value e / (n tau),
    // weight tau^2 / v.
    for (std::size_t x = 0; x < kBlock; ++x) {
        const double n = group.count[x];
        const double e = electronsPerDn * group.net[x];
        const double single = block.shot[x] * f.tau + f.floorVariance + excess[x];
        const double dark = f.darkVariance + excess[x] * f.excessInDark;
        const double inverse = 1 / (single + n * dark);  // 1 / (n v)
        const double weighted = e * inverse;
        block.w[x] += f.tau * f.tau * (n * inverse);
        block.wx[x] += f.tau * weighted;
        block.groups[x] += std::min(n, 1.0);
        squares[x] = e * weighted;
    }
    if (f.single) {
        for (std::size_t x = 0; x < kBlock; ++x) block.wxx[x] += squares[x];
    } else {
        for (std::size_t x = 0; x < kBlock; ++x)
            block.wxx[x] += squares[x] / (group.count[x] + kTiny);
    }
}

[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] BlockTotals conclude(
    double frames, const MergeBlock& block, const MergedBlock& out) {
    BlockOfPixels radiance, variance, chiSquare, freedom, unused;
    for (std::size_t x = 0; x < kBlock; ++x) {
        const double inverse = 1 / (block.w[x] + kTiny);
        radiance[x] = block.wx[x] * inverse;
        variance[x] = inverse;
        const double rest = block.wxx[x] - block.wx[x] * radiance[x];
        chiSquare[x] = block.groups[x] > 1 ? std::max(rest, 0.0) : 0;
        freedom[x] = std::max(block.groups[x] - 1, 0.0);
        unused[x] = 1 - std::min(block.groups[x], 1.0);
    }
    const std::size_t width = out.radiance.size();
    for (std::size_t x = 0; x < width; ++x) {
        const bool any = block.count[x] > 0;
        out.radiance[x] = any ? static_cast<float>(radiance[x]) : kNan;
        out.variance[x] = any ? static_cast<float>(variance[x]) : kNan;
    }
    for (std::size_t x = 0; x < width; ++x) {
        out.used[x] = capped(block.count[x]);
        out.saturated[x] = capped(frames - block.count[x]);
    }
    const auto behind = static_cast<double>(kBlock - width);  // pixels behind the end of the row
    return {
        .chiSquare = total(chiSquare), .freedom = total(freedom), .unused = total(unused) - behind};
}

}  // namespace gonio::proc
