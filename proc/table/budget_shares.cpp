#include "proc/table/budget_shares.h"

#include <cmath>

#include "proc/calibrate/budget_text.h"
#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

BudgetShare shareOf(const Budget& components) {
    BudgetShare share;
    for (const BudgetComponent& one : components) {
        if (!std::isfinite(one.medianRelative)) continue;
        if (one.correlation == Correlation::PerCell && one.type == 'B') {
            share.patch = share.cell = std::hypot(share.patch, std::sqrt(0.5) * one.medianRelative);
        }
        if (one.correlation == Correlation::PerState) {
            share.state = std::hypot(share.state, one.medianRelative);
        }
        if (one.correlation == Correlation::Common && one.name != "tilt of the sample") {
            share.common = std::hypot(share.common, one.medianRelative);
        }
    }
    return share;
}

}  // namespace

BudgetShares budgetShares(const SampleSet& set) {
    BudgetShares shares(set.leds.size());
    for (const StateBudget& state : readBudget(set.info.budgetJson)) {
        if (state.led < shares.size())
            shares[state.led][index(state.band)] = shareOf(state.components);
    }
    return shares;
}

std::size_t patchOf(std::size_t cell) {
    const CellPlace place = CellGrid::place(cell);
    const int ring = place.row / kPatchDegrees;
    const int middle = ring * kPatchDegrees + kPatchDegrees / 2;
    const int patches = CellGrid::sectors(middle) / kPatchDegrees;
    const int within = place.sector * patches / CellGrid::sectors(place.row);
    constexpr std::size_t kMostInRing = 360 / kPatchDegrees;
    return static_cast<std::size_t>(ring) * kMostInRing + static_cast<std::size_t>(within);
}

}  // namespace gonio::proc
