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

bool lightsAtOneAzimuth(std::span<const LightView> pairs) {
    constexpr double kSame = 1e-6;  // radians; files round
    const Direction* first = nullptr;
    for (const LightView& pair : pairs) {
        const Direction& wi = pair.in;
        const double sine = std::hypot(wi.x(), wi.y());
        if (sine <= kSame) continue;
        if (first == nullptr) first = &wi;
        const double cross = first->x() * wi.y() - first->y() * wi.x();
        const double dot = first->x() * wi.x() + first->y() * wi.y();
        if (std::abs(std::atan2(cross, dot)) > kSame) return false;
    }
    return true;
}

}  // namespace gonio::proc
