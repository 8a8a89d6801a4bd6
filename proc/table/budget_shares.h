#pragma once
// How a measured sample's systematic uncertainty splits by what it is shared with, read from its
// budget. Relative to f, each the root of the sum of squares of the medians. A sample without a
// budget, or with one that cannot be read, has shares of 0.
//
// A component of type B that the budget draws anew for each cell (the white's certificate by
// direction) is one whose correlation nobody stated. A tile does not change from one degree to the
// next: half of its variance is taken as alike over a patch of about 5 degrees and independent
// between patches, half as each cell's own. All as noise of the cells, it would vanish in the mean
// over a lobe; all as the patches', what runs within one would count as misfit.

#include <array>
#include <vector>

#include "proc/table/sample_set.h"

namespace gonio::proc {

struct BudgetShare {
    double cell = 0;   ///< of each cell alone
    double patch = 0;  ///< shared by the cells of one patch under one LED, in one band
    double state = 0;  ///< shared by one LED and band (the LED's drift)
    /// Shared by all values that were calibrated alike: the certificates. Not the sample's tilt,
    /// which moves f up on one side of a lobe and down on the other.
    double common = 0;
};
/// By LED, then band.
using BudgetShares = std::vector<std::array<BudgetShare, 3>>;

[[nodiscard]] BudgetShares budgetShares(const SampleSet& set);

inline constexpr int kPatchDegrees = 5;
inline constexpr std::size_t kPatches = std::size_t{90 / kPatchDegrees} * (360 / kPatchDegrees);
/// Of a cell of CellGrid; in [0, kPatches), not all of them in use.
[[nodiscard]] std::size_t patchOf(std::size_t cell);

}  // namespace gonio::proc
