#include "proc/table/reciprocal_average.h"

#include <array>
#include <cmath>
#include <optional>

#include "proc/optics/cell_blend.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/budget_shares.h"
#include "proc/table/cell_mean.h"

namespace gonio::proc {
namespace {

/// What a table sees of a direction of the rig's frame.
struct Sight {
    std::size_t cell = 0;
    CellValue value;
};

std::optional<Sight> sightOf(const CellSamples& cells, const Direction& wo, double shared) {
    const auto cell = CellGrid::cellAt(wo);
    if (!cell || !cells.usable(*cell) || !canAverage(cells, *cell)) return std::nullopt;
    double f = 0;
    const CellBlend around(wo);
    for (const CellWeight& one : around.cells()) {
        if (!cells.usable(one.cell)) return std::nullopt;
        f += one.weight * cells.f[one.cell];
    }
    Measured<double> value = cells.at(*cell);
    value.value = f;
    return Sight{*cell, {value, apartFrom(value, shared)}};
}

void move(CellSamples& cells, const Sight& sight, const CellMean& mean) {
    cells.f[sight.cell] += mean.mean.value - sight.value.value.value;
    cells.uRandom[sight.cell] = mean.uRandom();
    cells.uSystematic[sight.cell] = mean.mean.uSystematic;
    cells.flags[sight.cell].set(Flag::Reciprocity);
}

}  // namespace

Reciprocal reciprocalAverage(SampleSet set) {
    const BudgetShares shares = budgetShares(set);
    const std::vector<LedTable> before = set.leds;
    ConsistencySum sum;
    std::size_t pairs = 0;
    for (std::size_t a = 0; a < before.size(); ++a) {
        for (std::size_t b = a + 1; b < before.size(); ++b) {
            if (before[a].incidence == before[b].incidence) continue;
            const Radians apart = before[a].rotation - before[b].rotation;
            const auto toB = Direction::fromSpherical(before[b].incidence, apart);
            const auto toA = Direction::fromSpherical(before[a].incidence, -apart);
            for (std::size_t band = 0; band < 3; ++band) {
                const auto there = sightOf(before[a].bands[band], toB, shares[a][band].common);
                const auto back = sightOf(before[b].bands[band], toA, shares[b][band].common);
                if (!there || !back) continue;
                const std::array<CellValue, 2> values{there->value, back->value};
                const CellMean mean = meanOf(values);
                sum.add(mean.group);
                ++pairs;
                move(set.leds[a].bands[band], *there, mean);
                move(set.leds[b].bands[band], *back, mean);
            }
        }
    }
    return {std::move(set), sum.result(), pairs};
}

}  // namespace gonio::proc
