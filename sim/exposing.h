#pragma once
// An exposure as the rig plans and reports it: the settings it is taken with, the part of the
// sensor that is sent, and what its frame's LEADER and TRAILER say of it.

#include <array>
#include <cstdint>

#include "driver/protocol/chunk.h"
#include "proc/core/image.h"
#include "proc/core/units.h"
#include "sim/frame_flaw.h"
#include "sim/sensor.h"

namespace gonio::sim {

inline constexpr std::uint16_t kMaxFrames = 256;  ///< per ARM
inline constexpr std::uint8_t kControlLatency = 2;
inline constexpr std::uint8_t kRoiStep = 4;

struct Settings {
    int led = -1;  ///< -1: dark
    std::array<std::uint16_t, 3> levels{};
    std::uint32_t exposureUs = 1000;
    std::uint16_t gain = 0;
    void darken();
    bool operator==(const Settings&) const = default;
};

struct Format {
    driver::PixelFormat format = driver::PixelFormat::Mono12Packed;
    View view;
    int binning = 1;
};

struct Exposing {
    std::uint32_t number = 0;
    Settings settings;
    Settings pictured;  ///< with which it is really taken: others only where the frame is flawed
    FrameFlaw flaw = FrameFlaw::None;
    bool seated = true;       ///< the interlock has stayed closed
    Nanoseconds settling{0};  ///< for the LED that was changed before it
    Nanoseconds start{0}, end{0};
    std::uint64_t clockUs = 0;  ///< what the rig's clock is ahead of its time
};

/// LED board, sensor, body, ambient: 0.01 degC.
using Temperatures = std::array<std::int16_t, 4>;

/// What the drive levels draw, 0.1 mA.
[[nodiscard]] std::array<std::uint16_t, 3> currents(const std::array<std::uint16_t, 3>& levels);

[[nodiscard]] driver::Leader leaderOf(const Exposing& done,
                                      const Format& format,
                                      Size sent,
                                      const Digits& digits,
                                      const Temperatures& temperatures);
/// All but the bytes' count and CRC.
[[nodiscard]] driver::Trailer trailerOf(const Exposing& done,
                                        const Image<std::uint16_t>& image,
                                        const Digits& digits);

}  // namespace gonio::sim
