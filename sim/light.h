#pragma once
// The LEDs: four, at 0, 20, 40 and 60 degrees, phi = 0, each with R, G, B. Light is linear in the
// drive level. A rate is in electrons per second in a pixel in the middle of the field, at full
// level, for f cos(theta_o) = 1 / sr: 4.5e7 for green (a photon budget, not a vendor's figure).

#include <array>
#include <chrono>
#include <cstdint>

#include "proc/core/bands.h"
#include "proc/core/direction.h"
#include "proc/core/units.h"

namespace gonio::sim {

inline constexpr int kLeds = 4;
inline constexpr std::array<double, kLeds> kLedDegrees{0, 20, 40, 60};
inline constexpr std::array<std::uint16_t, 3> kFullCurrent{3500, 3500, 3500};  ///< 0.1 mA
inline constexpr std::uint8_t kSettleMs = 5;
inline constexpr Nanoseconds kSettling = std::chrono::milliseconds(kSettleMs);

[[nodiscard]] Direction ledDirection(int led);
[[nodiscard]] double ledRate(int led, Band band);

/// Light that reaches the camera past the sample (from the housing), in units of f cos(theta_o):
/// the same whatever lies under the rig, smooth over the field, about 3e-4.
[[nodiscard]] double strayLight(int led, const Direction& wo);

}  // namespace gonio::sim
