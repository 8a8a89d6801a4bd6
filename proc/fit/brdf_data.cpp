#include "proc/fit/brdf_data.h"

#include <algorithm>
#include <cmath>

namespace gonio::proc {

std::size_t BrdfData::valueCount() const {
    std::size_t count = 0;
    for (const FitRow& row : rows) {
        for (std::size_t b = 0; b < bandsUsed(); ++b) count += std::isfinite(row.f[b]) ? 1U : 0U;
    }
    return count;
}

bool BrdfData::sharesErrors() const {
    return std::any_of(shared.begin(), shared.end(), [](const auto& group) {
        return std::any_of(group.begin(), group.end(), [](const BudgetShare& share) {
            return share.patch > 0 || share.state > 0;
        });
    });
}

}  // namespace gonio::proc
