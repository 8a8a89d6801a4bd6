#include "proc/radiance/group_noise.h"

#include <algorithm>

namespace gonio::proc {

GroupFigures figuresOf(const GroupSums& group, const BracketSums& sums) {
    const double k = sums.noise.electronsPerDn;
    return {.tau = group.tau,
            .floorVariance = sums.noise.darkVariance(group.seconds, sums.members()),
            .darkVariance = group.dark->varianceOfMean * k * k,
            .excessInDark = 1.0 / std::max(1, group.dark->frames),
            .single = group.frames == 1};
}

void readGroup(const BracketSums& sums, std::size_t group, const BlockAt& at, GroupBlock& out) {
    const GroupSums& of = sums.groups[group];
    const auto dark = at.of(of.dark->mean);
    unpackTallies(at.of(of.tallies), dark, out);
    out.single = of.frames == 1;
    const Linearity& bent = sums.linearity;
    if (!bent.identity()) straighten({bent.blackDn, bent.rangeDn, bent.coefficients}, dark, out);
    const auto hotPixels = of.dark->hotInRow(at.y);
    out.anyHot = !hotPixels.empty();
    if (!out.anyHot) return;
    out.excess.fill(0);
    const double electrons = sums.noise.electronsPerDn / sums.members();
    for (const HotPixel& hot : hotPixels) {
        const auto x = static_cast<std::size_t>(hot.x - at.x);  // far to the right if on the left
        if (x < dark.size()) out.excess[x] = hot.excessDn * electrons;
    }
}

}  // namespace gonio::proc
