#pragma once
// How a measured sample's systematic uncertainty splits by what it is shared with, read from its
// budget: components of type B that are independent from cell to cell, and those shared by one LED
// and band. Relative to f, each the root of the sum of squares of the medians. A sample without a
// budget, or with one that cannot be read, has shares of 0.

#include <array>
#include <vector>

#include "proc/table/sample_set.h"

namespace gonio::proc {

struct BudgetShare {
    double perCell = 0;
    double perState = 0;
};
/// By LED, then band.
using BudgetShares = std::vector<std::array<BudgetShare, 3>>;

[[nodiscard]] BudgetShares budgetShares(const SampleSet& set);

}  // namespace gonio::proc
