#include "proc/fit/common_uncertainty.h"

#include <cmath>
#include <vector>

#include "proc/core/median.h"

namespace gonio::proc {

namespace {

/// Median over the band's positive values.
template <class Relative>
double medianOf(const BrdfData& data, std::size_t band, const Relative& relative) {
    if (!data.uKnown) return 0;
    std::vector<double> all;
    for (const FitRow& row : data.rows) {
        if (row.f[band] > 0) all.push_back(relative(row));
    }
    return all.empty() ? 0 : median(all);
}

}  // namespace

double commonRelative(const BrdfData& data, std::size_t band) {
    return medianOf(
        data, band, [&](const FitRow& row) { return row.uSystematic[band] / row.f[band]; });
}

double sharedRelative(const BrdfData& data, std::size_t band) {
    return medianOf(data, band, [&](const FitRow& row) {
        const BudgetShare share = data.shareOf(row, band);
        return std::hypot(row.uSystematic[band] / row.f[band], share.patch, share.state);
    });
}

}  // namespace gonio::proc
