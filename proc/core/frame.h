#pragma once
// A Frame is a valid picture from the rig with what it was really taken with: the values of its own
// LEADER and TRAILER, never what the host had asked for.

#include <array>
#include <cstdint>
#include <optional>

#include "proc/core/bands.h"
#include "proc/core/image.h"
#include "proc/core/units.h"

namespace gonio {

/// Drive levels of R, G, B, linear in current; 65535 = full.
struct LedLevels {
    std::array<std::uint16_t, 3> value{0, 0, 0};

    [[nodiscard]] static constexpr LedLevels only(Band band, std::uint16_t level) {
        LedLevels levels;
        levels.value[index(band)] = level;
        return levels;
    }
    [[nodiscard]] constexpr std::uint16_t operator[](Band b) const { return value[index(b)]; }
    [[nodiscard]] constexpr bool dark() const { return value == std::array<std::uint16_t, 3>{}; }
    bool operator==(const LedLevels&) const = default;
};

/// The part of the sensor that was read: x, y, width, height in sensor pixels, then binned.
struct Window {
    int x = 0, y = 0;
    Size size;        ///< in sensor pixels, before binning
    int binning = 1;  ///< 1, 2 or 4

    [[nodiscard]] Size sent() const { return {size.width / binning, size.height / binning}; }
    bool operator==(const Window&) const = default;
};

struct Frame {
    Image<std::uint16_t> pixels;  ///< DN, black level included
    std::uint64_t captureId = 0;
    int index = 0;             ///< within the capture
    std::uint32_t number = 0;  ///< the rig's frame_number since boot
    std::optional<int> led;    ///< empty: dark
    LedLevels levels;
    Exposure exposure;
    double gainDb = 0;
    Window window;
    int bitDepth = 12;
    std::uint16_t blackLevel = 0;  ///< DN
    /// Places in `celsius`, at the start of the exposure.
    enum Thermometer : std::size_t {
        LedBoard,
        Sensor,
        Body,
        Ambient
    };
    std::array<std::optional<double>, 4> celsius;
    std::array<double, 3> currentMinMilliamp{}, currentMaxMilliamp{};
    std::uint32_t saturatedPixels = 0;
    Microseconds start{0};  ///< on the rig's own clock, from its boot
};

}  // namespace gonio
