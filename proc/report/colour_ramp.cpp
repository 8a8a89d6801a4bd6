#include "proc/report/colour_ramp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace gonio::proc {
namespace {

using Rgb = std::array<double, 3>;

/// Into [0, 1]; NaN becomes 0.
double clamped(double t) { return std::fmin(std::fmax(t, 0.0), 1.0); }

// Anchors of equal lightness step (CIE L* 15 to 91), hue from blue-violet to yellow.
constexpr std::array<Rgb, 9> kAnchors{{{68, 1, 84},
                                       {71, 44, 122},
                                       {59, 81, 139},
                                       {44, 113, 142},
                                       {33, 144, 141},
                                       {39, 173, 129},
                                       {92, 200, 99},
                                       {170, 220, 50},
                                       {253, 231, 37}}};

}  // namespace

std::string rampColour(double t) {
    const double at = clamped(t) * static_cast<double>(kAnchors.size() - 1);
    const std::size_t left = std::min(static_cast<std::size_t>(at), kAnchors.size() - 2);
    const double blend = at - static_cast<double>(left);
    constexpr std::string_view kHex = "0123456789abcdef";
    std::string colour = "#";
    for (std::size_t c = 0; c < 3; ++c) {
        const double v = kAnchors[left][c] * (1 - blend) + kAnchors[left + 1][c] * blend;
        const auto byte = static_cast<unsigned>(std::lround(v));
        colour += kHex[byte / 16];
        colour += kHex[byte % 16];
    }
    return colour;
}

LogAxis LogAxis::covering(double lowest, double highest) {
    LogAxis axis;
    axis.firstDecade = static_cast<int>(std::floor(std::log10(lowest) + 1e-9));
    axis.lastDecade = static_cast<int>(std::ceil(std::log10(highest) - 1e-9));
    axis.lastDecade = std::max(axis.lastDecade, axis.firstDecade + 1);
    axis.firstDecade = std::max(axis.firstDecade, axis.lastDecade - 8);
    return axis;
}

double LogAxis::position(double value) const {
    if (!(value > 0)) return 0;
    const double t = (std::log10(value) - firstDecade) / (lastDecade - firstDecade);
    return clamped(t);
}

}  // namespace gonio::proc
