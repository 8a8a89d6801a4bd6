#include "proc/table/brdf_rows.h"

#include <cmath>

namespace gonio::proc {

bool BrdfRows::hasData(std::size_t pair, std::size_t channel) const {
    return !std::isnan(f[index(pair, channel)]);
}

Flags BrdfRows::flagsAt(std::size_t pair, std::size_t channel) const {
    if (!flags.empty()) return flags[index(pair, channel)];
    return hasData(pair, channel) ? Flags{Flag::Measured} : Flags{};
}

std::optional<double> BrdfRows::uAt(std::size_t pair, std::size_t channel) const {
    if (uRandom.empty()) return std::nullopt;
    const std::size_t at = index(pair, channel);
    const double u = std::hypot(uRandom[at], uSystematic.empty() ? 0.0 : uSystematic[at]);
    return std::isnan(u) ? std::nullopt : std::optional(u);
}

}  // namespace gonio::proc
