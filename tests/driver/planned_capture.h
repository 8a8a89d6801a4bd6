#pragma once
// A scripted rig with a small window, the capture that the tests ask it for, and ways to break its
// stream.

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "driver/rig.h"
#include "tests/driver/scripted_rig.h"

namespace gonio::driver::test {

inline constexpr std::uint64_t kSession = 0x1122334455667788;
inline constexpr Window kWindow{.x = 8, .y = 4, .size = {8, 6}, .binning = 1};
inline constexpr std::size_t kChunks = 7;  // of a frame of this window: LEADER, 5 x DATA, TRAILER

inline const CaptureRequest kRequest{.planStep = 5,
                                     .led = 2,
                                     .levels = LedLevels::only(Band::R, 65535),
                                     .exposure = Microseconds(1000),
                                     .frames = 3};

inline Rig configured(ScriptedRig& device) {
    auto rig = Rig::open(device, kSession);
    EXPECT_TRUE(rig) << rig.error().message;
    EXPECT_TRUE(rig->configure(kWindow));
    return std::move(*rig);
}

/// The frames that `request` asks for, as a rig gives them that nothing disturbs.
inline void expectUndisturbed(const Result<Capture>& capture, const CaptureRequest& request) {
    ASSERT_TRUE(capture) << capture.error().message;
    ASSERT_EQ(capture->size(), static_cast<std::size_t>(request.frames));
    int index = 0;
    for (const Frame& frame : *capture) {
        EXPECT_EQ(frame.index, index);
        EXPECT_EQ(frame.captureId >> 16, request.planStep);
        EXPECT_EQ(frame.led, request.led);
        EXPECT_EQ(frame.levels, request.levels);
        EXPECT_EQ(frame.exposure.requested, request.exposure);
        EXPECT_EQ(frame.exposure.granted, Nanoseconds(request.exposure) + Nanoseconds(260));
        EXPECT_EQ(frame.pixels, picture(kWindow.size, index));
        ++index;
    }
}

inline bool mentions(const Error& error, const std::string& text) {
    return error.message.find(text) != std::string::npos;
}

/// Calls `change` with the chunks of the first `times` sends only.
inline auto first(int times, std::function<void(std::vector<Bytes>&)> change) {
    return [times, change](std::vector<Bytes>& chunks) mutable {
        if (times-- > 0) change(chunks);
    };
}

inline auto drop(std::size_t at) {
    return [at](std::vector<Bytes>& chunks) {
        if (at < chunks.size()) chunks.erase(chunks.begin() + static_cast<std::ptrdiff_t>(at));
    };
}

}  // namespace gonio::driver::test
