#pragma once
// A rig that takes frames. A frame that it returns is valid in the sense of the
// protocol page: complete, with both CRCs agreeing, of the expected boot and
// capture, with all validity bits set, and with a LEADER that shows the
// geometry, LED, levels and exposure that were planned.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/assembler.h"
#include "driver/link.h"
#include "proc/core/frame.h"

namespace gonio::driver {

/// Who the rig is and what it can do.
struct RigInfo {
    std::string serial;
    std::vector<Radians> ledAngles;  ///< from the normal
    Size sensor;
    int bitDepth = 12;
    std::uint16_t blackLevel = 0;
    std::uint16_t fullScale = 0;
    Microseconds exposureMin{0}, exposureMax{0};
    Nanoseconds framePeriod{0};
    int maxFrames = 1;
};

struct CaptureRequest {
    std::uint64_t planStep = 0;  ///< capture_id = plan step << 16 | attempt
    std::optional<int> led;      ///< empty: dark
    LedLevels levels;
    Microseconds exposure{1000};
    int frames = 1;
};

class Rig {
public:
    /// `transport` must outlive the rig.
    [[nodiscard]] static Result<Rig> open(Transport& transport, std::uint64_t sessionId);
    Rig(Rig&&) noexcept = default;
    Rig& operator=(Rig&&) = delete;
    ~Rig();

    [[nodiscard]] RigInfo identify() const;
    /// The window that is read from now on. Taken exactly, or an error.
    Result<void> configure(const Window& window, PixelFormat format = PixelFormat::Mono12Packed);
    /// Exactly `frames` valid frames, in order. Missing chunks are asked for
    /// again (at most twice), then the capture is taken again (at most three
    /// times), then it fails with its evidence.
    [[nodiscard]] Result<std::vector<Frame>> capture(const CaptureRequest& request);
    /// All LEDs dark.
    Result<void> darken();
    /// Dark, and given back.
    Result<void> close();

    [[nodiscard]] const Anomalies& anomalies() const { return assembler_.anomalies(); }
    [[nodiscard]] RigLink& link() { return *link_; }

private:
    struct Settings {
        std::optional<int> led;
        LedLevels levels;
        Exposure exposure;
        std::uint32_t effectiveFrame = 0;
    };

    Rig(RigLink link, Assembler assembler);
    [[nodiscard]] Result<Settings> apply(const CaptureRequest& request);
    [[nodiscard]] Result<std::vector<Frame>> attempt(const CaptureRequest& request, int attempt);
    [[nodiscard]] Result<std::optional<RawFrame>> awaitFrame(int index,
                                                             std::uint64_t captureId,
                                                             Nanoseconds patience);
    [[nodiscard]] std::optional<std::string> objection(const RawFrame& frame,
                                                       const Settings& settings) const;
    [[nodiscard]] Frame toFrame(RawFrame raw, std::uint64_t captureId) const;

    std::unique_ptr<RigLink> link_;  // empty after a move
    Assembler assembler_;
    Window window_;
    PixelFormat format_ = PixelFormat::Mono12Packed;
};

}  // namespace gonio::driver
