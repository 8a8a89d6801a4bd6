#include "proc/fit/common_uncertainty.h"

#include <cmath>
#include <vector>

#include "proc/core/median.h"

namespace gonio::proc {

double commonRelative(const BrdfData& data, std::size_t band) {
    if (!data.uKnown) return 0;
    std::vector<double> relative;
    for (const FitRow& row : data.rows) {
        if (!(row.f[band] > 0)) continue;
        const BudgetShare share = data.shareOf(row, band);
        relative.push_back(
            std::hypot(row.uSystematic[band] / row.f[band], share.patch, share.state));
    }
    return relative.empty() ? 0 : median(relative);
}

}  // namespace gonio::proc
