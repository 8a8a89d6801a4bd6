#include "proc/radiance/merge_blocks.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace gonio::proc {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Eight pixels, of any instruction set: always inlined, as how a function is given them depends on
/// it.
constexpr std::size_t kLanes = 8;
using Lanes [[gnu::vector_size(kLanes * sizeof(double))]] = double;
constexpr Lanes kOnes{1, 1, 1, 1, 1, 1, 1, 1};

[[gnu::always_inline]] inline Lanes lanesAt(const BlockOfPixels& of, std::size_t x) {
    Lanes lanes;
    std::memcpy(&lanes, &of[x], sizeof lanes);
    return lanes;
}
[[gnu::always_inline]] inline void put(const Lanes& lanes, BlockOfPixels& into, std::size_t x) {
    std::memcpy(&into[x], &lanes, sizeof lanes);
}
[[gnu::always_inline]] inline Lanes positive(const Lanes& lanes) {
    return lanes > 0 ? lanes : Lanes{};
}
/// What is added to readings in units of the range, DN; below 0 the response is straight.
[[gnu::always_inline]] inline Lanes correction(const Bend& bend, const Lanes& reading) {
    const Lanes above = positive(reading);
    const Lanes m = above < 1 ? above : kOnes;
    Lanes sum{};
    for (std::size_t a = bend.coefficients.size(); a > 0; --a)
        sum = (sum + bend.coefficients[a - 1]) * m;
    const Lanes below = reading < 0 ? reading : Lanes{};
    return bend.range * (sum + bend.coefficients.front() * below);
}
[[gnu::always_inline]] inline double total(const Lanes& lanes) {
    double sum = 0;
    for (std::size_t i = 0; i < kLanes; ++i) sum += lanes[i];
    return sum;
}

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
    BlockOfPixels base{};  // the dark's reading over black
    for (std::size_t x = 0; x < dark.size(); ++x)
        base[x] = static_cast<double>(dark[x]) - bend.black;
    const double scale = 1 / bend.range;
    for (std::size_t x = 0; x < kBlock; x += kLanes) {
        const Lanes n = lanesAt(block.count, x);
        Lanes net = lanesAt(block.net, x);
        Lanes mean = net;
        if (!block.single) mean /= n > 1 ? n : kOnes;  // a quotient takes as long as the rest
        const Lanes dim = lanesAt(base, x);
        net += n * (correction(bend, (mean + dim) * scale) - correction(bend, dim * scale));
        put(net, block.net, x);
    }
}

[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] BlockTotals mergeBlock(
    std::span<const GroupBlock> groups,
    std::span<const GroupFigures> figures,
    const BracketFigures& bracket,
    const MergedBlock& out) {
    const double k = bracket.electronsPerDn;
    const double perCount = k / bracket.members;
    BlockOfPixels radiance, variance, count;
    Lanes chiSquare{}, freedom{}, unused{};
    for (std::size_t x = 0; x < kBlock; x += kLanes) {
        Lanes net{}, samples{}, tau{};
        for (std::size_t g = 0; g < groups.size(); ++g) {
            const Lanes n = lanesAt(groups[g].count, x);
            net += lanesAt(groups[g].net, x);
            samples += n;
            tau += figures[g].tau * n;
        }
        // Variance of the pooled light, electrons^2 per second.
        const Lanes shot = positive(perCount * net / (tau + kTiny));
        Lanes w{}, wx{}, wxx{}, seen{};
        for (std::size_t g = 0; g < groups.size(); ++g) {
            const GroupFigures& f = figures[g];
            const Lanes n = lanesAt(groups[g].count, x);
            const Lanes e = k * lanesAt(groups[g].net, x);
            // With n samples of sum e: variance of the mean v = single / n + dark, value
            // e / (n tau), weight tau^2 / v.
            Lanes single = shot * f.tau + f.floorVariance;
            Lanes dark = f.darkVariance + Lanes{};
            if (groups[g].anyHot) {
                const Lanes excess = lanesAt(groups[g].excess, x);
                single += excess;
                dark += excess * f.excessInDark;
            }
            const Lanes inverse = 1 / (single + n * dark);  // 1 / (n v)
            const Lanes weighted = e * inverse;
            w += f.tau * f.tau * (n * inverse);
            wx += f.tau * weighted;
            wxx += f.single ? e * weighted : e * weighted / (n + kTiny);
            seen += n > 0 ? kOnes : Lanes{};
        }
        const Lanes inverse = 1 / (w + kTiny);
        const Lanes mean = wx * inverse;
        chiSquare += seen > 1 ? positive(wxx - wx * mean) : Lanes{};
        freedom += positive(seen - 1);
        unused += seen > 0 ? Lanes{} : kOnes;
        put(mean, radiance, x);
        put(inverse, variance, x);
        put(samples, count, x);
    }
    const std::size_t width = out.radiance.size();
    for (std::size_t x = 0; x < width; ++x) {
        const bool any = count[x] > 0;
        out.radiance[x] = any ? static_cast<float>(radiance[x]) : kNan;
        out.variance[x] = any ? static_cast<float>(variance[x]) : kNan;
    }
    for (std::size_t x = 0; x < width; ++x) {
        out.used[x] = capped(count[x]);
        out.saturated[x] = capped(bracket.frames - count[x]);
    }
    const auto behind = static_cast<double>(kBlock - width);  // pixels behind the end of the row
    return {
        .chiSquare = total(chiSquare), .freedom = total(freedom), .unused = total(unused) - behind};
}

}  // namespace gonio::proc
