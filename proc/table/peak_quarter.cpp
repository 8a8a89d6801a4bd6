#include "proc/table/peak_quarter.h"

#include <algorithm>
#include <cmath>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

constexpr double kClear = 1.2;
constexpr double kNear = 7.5;

double turnsApart(double a, double b) { return std::abs(std::remainder(a - b, 360)); }

std::optional<std::size_t> nearest(const std::vector<double>& axis,
                                   double at,
                                   double (*apart)(double, double)) {
    if (axis.empty()) return std::nullopt;
    const auto found = std::min_element(
        axis.begin(), axis.end(), [&](double a, double b) { return apart(a, at) < apart(b, at); });
    if (!(apart(*found, at) <= kNear)) return std::nullopt;
    return static_cast<std::size_t>(found - axis.begin());
}

std::optional<std::size_t> azimuthNear(const SphericalTable& table,
                                       const SphericalBlock& block,
                                       double fromMirror) {
    const double mirror = table.mirrorAzimuthDeg;
    if (const auto here = nearest(block.azimuthDeg, mirror + fromMirror, turnsApart)) return here;
    if (!table.planeSymmetrical) return std::nullopt;
    return nearest(block.azimuthDeg, mirror - fromMirror, turnsApart);
}

/// 0..3; empty where no quarter wins.
std::optional<std::size_t> winner(const SphericalTable& table, const SphericalBlock& block) {
    const auto theta = nearest(
        block.thetaDeg, block.incidenceDeg, [](double a, double b) { return std::abs(a - b); });
    if (!theta) return std::nullopt;
    std::array<double, 4> f{};
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
        const auto azimuth = azimuthNear(table, block, 90.0 * static_cast<double>(quarter));
        if (!azimuth) return std::nullopt;
        f[quarter] = block.f[block.index(*azimuth, *theta)];
        if (std::isnan(f[quarter])) return std::nullopt;
    }
    const auto best = static_cast<std::size_t>(std::max_element(f.begin(), f.end()) - f.begin());
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
        if (quarter != best && !(f[best] >= kClear * std::max(f[quarter], 0.0) && f[best] > 0)) {
            return std::nullopt;
        }
    }
    return best;
}

}  // namespace

std::array<std::size_t, 4> peakQuarters(const SphericalTable& table) {
    std::array<std::size_t, 4> count{};
    for (const SphericalBlock& block : table.blocks) {
        if (block.transmission || block.incidenceDeg < 10 || block.incidenceDeg > 75) continue;
        if (const auto quarter = winner(table, block)) ++count[*quarter];
    }
    return count;
}

std::optional<std::string> peakWarning(const SphericalTable& table) {
    const std::array<std::size_t, 4> count = peakQuarters(table);
    const auto most =
        static_cast<std::size_t>(std::max_element(count.begin(), count.end()) - count.begin());
    if (count[most] == count[0]) return std::nullopt;
    const double seen = std::fmod(table.mirrorAzimuthDeg + 90.0 * static_cast<double>(most), 360.0);
    return "in " + std::to_string(count[most]) + " blocks the peak lies at azimuth " +
           shortest(seen) + ", where the format has " +
           (most == 2 ? "the light" : "neither light nor mirror") + "; its mirror direction is " +
           shortest(table.mirrorAzimuthDeg) +
           ": a retroreflector, or another convention; read as " + "the format says";
}

}  // namespace gonio::proc
