#pragma once
// What a frame was meant to be, and whether it is (PROTOCOL.md 3, "A frame is valid"). A
// photometric verdict, not only one of transport: geometry, LED, levels, granted exposure and gain
// of the LEADER must be the planned ones, and all validity bits of the TRAILER set. A frame from
// before the settings took effect is Early: nothing is wrong with it, it is merely not the one
// wanted.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "driver/assembler.h"
#include "driver/protocol/reports.h"
#include "proc/core/frame.h"

namespace gonio::driver {

struct FramePlan {
    Window window;
    PixelFormat format = PixelFormat::Mono12Packed;
    std::optional<int> led;  ///< empty: dark
    LedLevels levels;
    Exposure exposure;
    std::uint16_t gain = 0;            ///< granted, 0.01 dB
    std::uint32_t effectiveFrame = 0;  ///< the first frame that has all settings
    int bitDepth = 12;
};

struct Early {};
struct Rejected {
    std::string why;  ///< "LEADER led 1, planned 2"
};

/// Bytes of a frame as sent; empty for an unknown format or an empty window.
[[nodiscard]] std::optional<std::uint32_t> frameBytes(const Window& window, PixelFormat format);

using Verdict = std::variant<Frame, Early, Rejected>;

/// Precondition: `wire.bytes` holds frameBytes(plan.window, plan.format) bytes. A Frame takes
/// `memory` for its pixels, where that has their size.
[[nodiscard]] Verdict judge(const WireFrame& wire,
                            const FramePlan& plan,
                            Image<std::uint16_t>& memory);
[[nodiscard]] Verdict judge(const WireFrame& wire, const FramePlan& plan);

}  // namespace gonio::driver
