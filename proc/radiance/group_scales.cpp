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
        : all(groups),
          pairs(std::max<std::size_t>(groups, 1) - 1, ScaleSystem(2)),
          rate(groups),
          weight(groups) {}
    void operator+=(const Systems& other) {
        all += other.all;
        for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] += other.pairs[i];
    }
    ScaleSystem all;
    std::vector<ScaleSystem> pairs;
    std::vector<double> rate, weight;  ///< of the pixel at hand, by group
};

class Comparison {
public:
    Comparison(const BracketSums& sums, const MergedState& state)
        : sums_(sums), state_(state), order_(byTau(sums)) {
        for (const GroupSums& group : sums.groups) figures_.push_back(figuresOf(group, sums));
    }

    [[nodiscard]] Systems row(int y) const {
        Systems systems(figures_.size());
        std::vector<GroupBlock> groups(figures_.size());
        for (int x = 0; x < sums_.traits.size.width; x += static_cast<int>(kBlock)) {
            const BlockAt at{x, y};
            for (std::size_t g = 0; g < groups.size(); ++g) readGroup(sums_, g, at, groups[g]);
            for (std::size_t i = 0; i < at.of(state_.radiance).size(); ++i)
                pixel(groups, at, i, systems);
        }
        return systems;
    }

    [[nodiscard]] const std::vector<std::size_t>& order() const { return order_; }

private:
    void pixel(const std::vector<GroupBlock>& groups,
               const BlockAt& at,
               std::size_t i,
               Systems& systems) const {
        const auto light = lightAround(state_.radiance, at.x + static_cast<int>(i), at.y);
        if (!light) return;
        std::vector<double>& rate = systems.rate;
        std::vector<double>& weight = systems.weight;
        std::fill(weight.begin(), weight.end(), 0.0);
        for (std::size_t g = 0; g < groups.size(); ++g) {
            const GroupFigures& f = figures_[g];
            const double n = groups[g].count[i];
            if (groups[g].anyHot && groups[g].excess[i] > 0) return;
            if (n == 0) continue;
            const double single = *light * f.tau / sums_.members() + f.floorVariance;
            weight[g] = f.tau * f.tau / (single / n + f.darkVariance);
            rate[g] = groups[g].net[i] * sums_.noise.electronsPerDn / (n * f.tau);
        }
        systems.all.add(*light, rate, weight);
        for (std::size_t pair = 0; pair < systems.pairs.size(); ++pair) {
            const std::size_t from = order_[pair], to = order_[pair + 1];
            systems.pairs[pair].add(
                *light, std::array{rate[from], rate[to]}, std::array{weight[from], weight[to]});
        }
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
