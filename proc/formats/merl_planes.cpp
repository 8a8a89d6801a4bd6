#include "proc/formats/merl_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace gonio::proc {
namespace {

constexpr std::size_t kBlock = 512;  // doubles that stay in the first cache

struct BlockCounts {
    std::size_t negative = 0;
    std::size_t odd = 0;  ///< NaN or infinite
};

BlockCounts decodeBlock(double* values, std::size_t count, double scale) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kMost = std::numeric_limits<double>::max();
    BlockCounts counts;
    for (std::size_t i = 0; i < count; ++i) {
        const double stored = values[i];
        counts.negative += stored < 0 ? 1U : 0U;
        counts.odd += std::abs(stored) <= kMost ? 0U : 1U;
        values[i] = stored < 0 ? kNan : stored * scale;
    }
    return counts;
}

}  // namespace

MerlPlane decodeMerlPlane(std::string_view bytes, double scale) {
    MerlPlane plane;
    const std::size_t count = bytes.size() / sizeof(double);
    plane.f.reserve(count);
    std::array<double, kBlock> block{};
    std::size_t odd = 0;
    // Through a block on the stack: the plane's memory is touched once, without being cleared.
    for (std::size_t at = 0; at < count; at += kBlock) {
        const std::size_t size = std::min(kBlock, count - at);
        std::memcpy(block.data(), bytes.data() + at * sizeof(double), size * sizeof(double));
        const BlockCounts counts = decodeBlock(block.data(), size, scale);
        plane.negative += counts.negative;
        odd += counts.odd;
        plane.f.insert(plane.f.end(), block.data(), block.data() + size);
    }
    plane.finite = odd == 0;
    return plane;
}

}  // namespace gonio::proc
