#include "proc/radiance/group_scales.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "proc/core/parallel.h"
#include "proc/radiance/group_noise.h"

namespace gonio::proc {
namespace {

/// The groups from the smallest to the largest tau.
std::vector<std::size_t> byTau(const BracketSums& sums) {
    std::vector<std::size_t> order(sums.groups.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return sums.groups[a].tau < sums.groups[b].tau;
    });
    return order;
}

/// All groups at once, and each pair of neighbours.
struct Systems {
    explicit Systems(std::size_t groups)
        : all(groups), pairs(std::max<std::size_t>(groups, 1) - 1, ScaleSystem(2)) {}
    void operator+=(const Systems& other) {
        all += other.all;
        for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] += other.pairs[i];
    }
    ScaleSystem all;
    std::vector<ScaleSystem> pairs;
};

class Comparison {
public:
    Comparison(const BracketSums& sums, const MergedState& state)
        : sums_(sums), state_(state), order_(byTau(sums)) {
        for (const GroupSums& group : sums.groups) figures_.push_back(figuresOf(group, sums));
    }

    /// None at the edge of the picture, where a pixel's surroundings are not known.
    [[nodiscard]] Systems row(int y) const {
        Systems systems(figures_.size());
        const Size size = sums_.traits.size;
        if (y < 1 || y + 1 >= size.height) return systems;
        std::vector<NodeBlock> nodes(figures_.size());
        for (int x = 1; x + 1 < size.width; x += static_cast<int>(kBlock))
            block({x, y}, nodes, systems);
        return systems;
    }

    [[nodiscard]] const std::vector<std::size_t>& order() const { return order_; }

private:
    void block(const BlockAt& at, std::vector<NodeBlock>& nodes, Systems& systems) const {
        const auto around = [&](int y) {
            return state_.radiance.row(y).subspan(static_cast<std::size_t>(at.x) - 1);
        };
        BlockOfPixels light;
        findLight(around(at.y - 1), around(at.y), around(at.y + 1), light);
        const PixelFigures pixel{.electronsPerDn = sums_.noise.electronsPerDn,
                                 .members = static_cast<double>(sums_.members())};
        GroupBlock group;
        BlockOfPixels cool = light;
        std::vector<const NodeBlock*> all;
        for (std::size_t g = 0; g < nodes.size(); ++g) {
            readGroup(sums_, g, at, group);
            dropHot(group, cool);
            nodes[g] = asNode(group, figures_[g], pixel, light);
            all.push_back(&nodes[g]);
        }
        systems.all.add(cool, all);
        for (std::size_t pair = 0; pair < systems.pairs.size(); ++pair)
            systems.pairs[pair].add(cool, std::array{all[order_[pair]], all[order_[pair + 1]]});
    }

    const BracketSums& sums_;
    const MergedState& state_;
    std::vector<std::size_t> order_;
    std::vector<GroupFigures> figures_;
};

/// Rows of a large picture are left out evenly: a quarter million of pixels tell a scale to 1e-4.
Systems compared(const BracketSums& sums, const Comparison& comparison) {
    constexpr std::size_t kEnoughPixels = std::size_t{1} << 18U;
    const auto height = static_cast<std::size_t>(sums.traits.size.height);
    const std::size_t step =
        std::clamp<std::size_t>(sums.traits.size.pixels() / kEnoughPixels, 1, height);
    const std::size_t count = (height - step / 2 + step - 1) / step;
    std::vector<Systems> rows(count, Systems(0));  // added in order: the same on any cores
    parallelFor(count, [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i)
            rows[i] = comparison.row(static_cast<int>(i * step + step / 2));
    });
    Systems all(sums.groups.size());
    for (const Systems& row : rows) all += row;
    return all;
}

}  // namespace

double NominalUncertainty::of(const GroupSums& group) const {
    const double ofLevel = group.level < 65535 ? dimmed : 0;
    return std::hypot(exposure.count() / group.seconds, relative, ofLevel);
}

ScaleReport groupScales(const BracketSums& sums,
                        const MergedState& state,
                        const NominalUncertainty& nominal) {
    const Comparison comparison(sums, state);
    const Systems systems = compared(sums, comparison);
    ScaleReport report;
    std::vector<double> uNominal;
    uNominal.reserve(sums.groups.size());
    for (const GroupSums& group : sums.groups) uNominal.push_back(nominal.of(group));
    const std::vector<BrightnessOffset> offsets = systems.all.solve(uNominal);
    for (std::size_t g = 0; g < offsets.size(); ++g) {
        report.groups.push_back({.granted = sums.groups[g].granted,
                                 .level = sums.groups[g].level,
                                 .uNominal = uNominal[g],
                                 .offset = offsets[g]});
    }
    const Eigen::Vector2d second{0, 1};
    for (std::size_t pair = 0; pair < systems.pairs.size(); ++pair) {
        const auto offset = systems.pairs[pair].along(second);
        if (!offset) continue;
        report.ratios.push_back({.from = comparison.order()[pair],
                                 .to = comparison.order()[pair + 1],
                                 .offset = *offset});
    }
    return report;
}

void correctScales(MergeAccumulator& accumulator, const ScaleReport& report) {
    for (std::size_t g = 0; g < report.groups.size(); ++g)
        accumulator.scaleGroup(g, 1 + report.groups[g].offset.size);
}

}  // namespace gonio::proc
