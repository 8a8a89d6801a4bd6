#include "proc/table/reciprocal_average.h"

#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "proc/optics/cell_blend.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/budget_shares.h"
#include "proc/table/cell_mean.h"
#include "proc/table/rotations.h"

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

/// LED, band, cell.
using Place = std::array<std::size_t, 3>;

/// For each cell its own value, then what each partner makes of it. Whatever the number of
/// partners, a cell moves once, to the mean of all.
class Gathered {
public:
    explicit Gathered(const std::vector<LedTable>& leds) : leds_(leds) {}

    /// `partner` is of the direction that `own` is of; the cell would move by their difference.
    void add(const Place& place, const Sight& own, CellValue partner) {
        const double f = leds_[place[0]].bands[place[1]].f[place[2]];
        std::vector<CellValue>& values = values_[place];
        if (values.empty()) {
            values.push_back(own.value);
            values.back().value.value = f;
        }
        partner.value.value += f - own.value.value.value;
        values.push_back(partner);
    }

    void moveCells(std::vector<LedTable>& leds) const {
        for (const auto& [place, values] : values_) {
            CellSamples& cells = leds[place[0]].bands[place[1]];
            const CellMean mean = meanOf(values);
            cells.f[place[2]] = mean.mean.value;
            cells.uRandom[place[2]] = mean.uRandom();
            cells.uSystematic[place[2]] = mean.mean.uSystematic;
            cells.flags[place[2]].set(Flag::Reciprocity);
        }
    }

private:
    const std::vector<LedTable>& leds_;
    std::map<Place, std::vector<CellValue>> values_;
};

}  // namespace

Reciprocal reciprocalAverage(SampleSet set) {
    const BudgetShares shares = budgetShares(set);
    const std::vector<LedTable> before = set.leds;
    Gathered gathered(before);
    ConsistencySum sum;
    std::size_t pairs = 0;
    for (std::size_t a = 0; a < before.size(); ++a) {
        for (std::size_t b = a + 1; b < before.size(); ++b) {
            if (sameLight(before[a], before[b])) continue;
            const Radians apart = before[a].rotation - before[b].rotation;
            const auto toB = Direction::fromSpherical(before[b].incidence, apart);
            const auto toA = Direction::fromSpherical(before[a].incidence, -apart);
            for (std::size_t band = 0; band < 3; ++band) {
                const auto there = sightOf(before[a].bands[band], toB, shares[a][band].common);
                const auto back = sightOf(before[b].bands[band], toA, shares[b][band].common);
                if (!there || !back) continue;
                const std::array<CellValue, 2> values{there->value, back->value};
                sum.add(meanOf(values).group);
                ++pairs;
                gathered.add({a, band, there->cell}, *there, back->value);
                gathered.add({b, band, back->cell}, *back, there->value);
            }
        }
    }
    gathered.moveCells(set.leds);
    return {std::move(set), sum.result(), pairs};
}

}  // namespace gonio::proc
