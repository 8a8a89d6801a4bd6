#include "sim/light.h"

#include <cstddef>

namespace gonio::sim {
namespace {

constexpr double kGreenRate = 4.5e7;
constexpr std::array<double, kLeds> kLedFactor{1, 0.95, 0.9, 0.85};
constexpr std::array<double, 3> kBandFactor{0.8, 1.0, 0.7};
constexpr double kStray = 3e-4;

}  // namespace

Direction ledDirection(int led) {
    return Direction::fromSpherical(
        Radians::fromDegrees(kLedDegrees[static_cast<std::size_t>(led)]), Radians(0));
}

double ledRate(int led, Band band) {
    return kGreenRate * kLedFactor[static_cast<std::size_t>(led)] * kBandFactor[index(band)];
}

double strayLight(int led, const Direction& wo) {
    const double side = ledDirection(led).vector().dot(wo.vector());
    return kStray * (0.7 + 0.3 * side + 0.2 * wo.y() * wo.y());
}

}  // namespace gonio::sim
