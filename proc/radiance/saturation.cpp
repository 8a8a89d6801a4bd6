#include "proc/radiance/saturation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace gonio::proc {
namespace {

/// The places before and after `at` in a line of `count`; at an end the one inside, twice.
struct Beside {
    int before, after;
};
Beside beside(int at, int count) {
    const int last = count - 1;
    if (last == 0) return {0, 0};
    return {at == 0 ? 1 : at - 1, at == last ? last - 1 : at + 1};
}

/// A row and its neighbours, and below what the sum of the four and the sample itself must stay.
struct Rows {
    std::span<const std::uint16_t> above, here, below;
    int mostAround, most;

    [[nodiscard]] std::uint8_t verdict(std::size_t x, std::size_t left, std::size_t right) const {
        const int around = here[left] + here[right] + above[x] + below[x];
        return static_cast<std::uint8_t>(static_cast<int>(around < mostAround) &
                                         static_cast<int>(here[x] < most));
    }
};

/// All but the ends.
[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] void markInside(
    const Rows& borrowed, std::span<std::uint8_t> usable) {
    const Rows rows = borrowed;
    const std::size_t last = usable.size() - 1;
    for (std::size_t x = 1; x < last; ++x) usable[x] = rows.verdict(x, x - 1, x + 1);
}

}  // namespace

void markUsable(const Image<std::uint16_t>& picture,
                int y,
                const SensorNoise& noise,
                std::span<std::uint8_t> usable) {
    assert(usable.size() == static_cast<std::size_t>(picture.width()));
    const Beside rows = beside(y, picture.height());
    // Whole numbers: sum < s is sum < ceil(s).
    const Rows around{.above = picture.row(rows.before),
                      .here = picture.row(y),
                      .below = picture.row(rows.after),
                      .mostAround = static_cast<int>(std::ceil(4 * noise.saturationDn())),
                      .most = static_cast<int>(std::ceil(noise.ceilingDn()))};
    const auto atEnd = [&](std::size_t x) {
        const Beside columns = beside(static_cast<int>(x), picture.width());
        return around.verdict(
            x, static_cast<std::size_t>(columns.before), static_cast<std::size_t>(columns.after));
    };
    markInside(around, usable);
    usable.front() = atEnd(0);
    usable.back() = atEnd(usable.size() - 1);
}

bool usableReference(
    const Image<std::uint16_t>& picture, int x, int y, const SensorNoise& noise, double excessDn) {
    const Beside columns = beside(x, picture.width());
    const Beside rows = beside(y, picture.height());
    const double around = picture.at(columns.before, y) + picture.at(columns.after, y) +
                          picture.at(x, rows.before) + picture.at(x, rows.after);
    return around / 4 + excessDn < noise.saturationDn() && picture.at(x, y) < noise.ceilingDn();
}

}  // namespace gonio::proc
