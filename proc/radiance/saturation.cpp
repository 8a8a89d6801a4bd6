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

}  // namespace

void markUsable(const Image<std::uint16_t>& picture,
                int y,
                const SensorNoise& noise,
                std::span<std::uint8_t> usable) {
    assert(usable.size() == static_cast<std::size_t>(picture.width()));
    const Beside rows = beside(y, picture.height());
    const auto above = picture.row(rows.before);
    const auto here = picture.row(y);
    const auto below = picture.row(rows.after);
    // Whole numbers: sum < s is sum < ceil(s).
    const int mostAround = static_cast<int>(std::ceil(4 * noise.saturationDn()));
    const int most = static_cast<int>(std::ceil(noise.ceilingDn()));
    const auto verdict = [&](std::size_t x, std::size_t left, std::size_t right) {
        const int around = here[left] + here[right] + above[x] + below[x];
        return static_cast<std::uint8_t>(static_cast<int>(around < mostAround) &
                                         static_cast<int>(here[x] < most));
    };
    const std::size_t last = here.size() - 1;
    const auto atEnd = [&](std::size_t x) {
        const Beside columns = beside(static_cast<int>(x), picture.width());
        return verdict(
            x, static_cast<std::size_t>(columns.before), static_cast<std::size_t>(columns.after));
    };
    usable[0] = atEnd(0);
    for (std::size_t x = 1; x < last; ++x) usable[x] = verdict(x, x - 1, x + 1);
    usable[last] = atEnd(last);
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
