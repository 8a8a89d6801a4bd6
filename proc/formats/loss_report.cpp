#include "proc/formats/loss_report.h"

#include <algorithm>

namespace gonio::proc {

void LossReport::add(Loss kind, std::string what, std::size_t count) {
    if (count == 0) return;
    const auto known = std::find_if(items.begin(), items.end(), [&](const Item& item) {
        return item.kind == kind && item.what == what;
    });
    if (known != items.end()) {
        known->count += count;
    } else {
        items.push_back({.kind = kind, .what = std::move(what), .count = count});
    }
}

std::string_view name(Loss kind) {
    switch (kind) {
        case Loss::Resampled: return "resampled";
        case Loss::Clamped: return "clamped";
        case Loss::Masked: return "masked";
        case Loss::Extrapolated: return "extrapolated";
        case Loss::Dropped: return "dropped";
    }
    return "lost";
}

}  // namespace gonio::proc
