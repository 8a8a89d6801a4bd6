#include "proc/table/plane_symmetry.h"

#include <array>
#include <cmath>

#include "proc/optics/cell_grid.h"
#include "proc/table/budget_shares.h"
#include "proc/table/cell_mean.h"

namespace gonio::proc {
namespace {

/// Hands `use` each pair of a table's cells with their mean: cell, its image, mean.
template <class Use>
void forEachPair(const CellSamples& cells, double shared, const Use& use) {
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const std::size_t image = mirroredCell(cell);
        if (image <= cell || !canAverage(cells, cell) || !canAverage(cells, image)) continue;
        const Measured<double> one = cells.at(cell), other = cells.at(image);
        const std::array<CellValue, 2> values{
            {{one, apartFrom(one, shared)}, {other, apartFrom(other, shared)}}};
        use(cell, image, meanOf(values));
    }
}

}  // namespace

std::size_t mirroredCell(std::size_t cell) {
    const CellPlace place = CellGrid::place(cell);
    return CellGrid::index({place.row, CellGrid::sectors(place.row) - 1 - place.sector});
}

Symmetrical planeSymmetrical(SampleSet set) {
    const BudgetShares shares = budgetShares(set);
    ConsistencySum sum;
    for (std::size_t led = 0; led < set.leds.size(); ++led) {
        for (std::size_t band = 0; band < 3; ++band) {
            const BudgetShare& share = shares[led][band];
            CellSamples& cells = set.leds[led].bands[band];
            const CellSamples before = cells;
            forEachPair(before,
                        std::hypot(share.common, share.state),
                        [&](std::size_t cell, std::size_t image, const CellMean& mean) {
                            sum.add(mean.group);
                            const double n = before.nEff[cell] + before.nEff[image];
                            for (const std::size_t at : {cell, image}) {
                                cells.f[at] = mean.mean.value;
                                cells.uRandom[at] = mean.uRandom();
                                cells.uSystematic[at] = mean.mean.uSystematic;
                                cells.flags[at] = mean.mean.flags;
                                cells.nEff[at] = n;
                            }
                        });
        }
    }
    return {std::move(set), sum.result()};
}

Consistency planeConsistency(const SampleSet& set) {
    const BudgetShares shares = budgetShares(set);
    ConsistencySum sum;
    for (std::size_t led = 0; led < set.leds.size(); ++led) {
        for (std::size_t band = 0; band < 3; ++band) {
            const BudgetShare& share = shares[led][band];
            forEachPair(
                set.leds[led].bands[band],
                std::hypot(share.common, share.state),
                [&](std::size_t, std::size_t, const CellMean& mean) { sum.add(mean.group); });
        }
    }
    return sum.result();
}

}  // namespace gonio::proc
