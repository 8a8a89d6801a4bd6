#pragma once
// The uncertainty budget of a sample as a report shows it.

#include <cstddef>

#include "proc/report/html_page.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

/// A row for each component: how it was evaluated, how it correlates, size of the input, relative
/// standard uncertainty of f by band (median over the states of that band, each a median over its
/// cells), its share of the variance (mean over the bands), degrees of freedom. Then by band: the
/// root of the sum of squares, and U of it (k = 2); "at least" where some component says nothing of
/// the band, "not known" where none does. Without rows where there is no budget.
[[nodiscard]] HtmlTable budgetTable(const SampleSet& sample);

/// What the cells themselves hold, by incidence and band: the median and the 95th percentile of
/// relative u (k = 1), and the median of U (k = 2).
[[nodiscard]] HtmlTable achievedTable(const SampleSet& sample);

/// Number of cells whose uncertainty is that of Monte Carlo.
[[nodiscard]] std::size_t monteCarloCells(const SampleSet& sample);

}  // namespace gonio::proc
