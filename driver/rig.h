#pragma once
// A rig that takes frames. A frame that it returns is valid in the sense of PROTOCOL.md 3:
// complete, both CRC levels agreeing, of the expected boot and capture, all validity bits set, with
// a LEADER that shows the geometry, LED, levels, exposure and gain that were planned. Frames from
// before the settings took effect are discarded and replaced. Lost chunks are asked for again (at
// most twice per frame), then what is still missing is captured again (at most three times), then
// the capture fails with its evidence. A frame keeps its index through all repairs: a repaired
// capture holds what an undisturbed one would. After an error, and after close(), the LEDs are
// dark. Before configure(): capture() is a Usage error. While nothing is called nobody feeds the
// heartbeat: call keepAlive() when busy elsewhere, or the rig goes dark by itself.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/assembler.h"
#include "driver/frame_plan.h"
#include "driver/link.h"
#include "proc/core/frame.h"

namespace gonio::driver {

/// Who the rig is and what it can do.
struct RigInfo {
    std::string serial;
    std::vector<Radians> ledAngles;  ///< from the normal; above 90 degrees: transmission module
    Size sensor;
    int bitDepth = 12;
    std::uint16_t blackLevel = 0;
    std::uint16_t fullScale = 0;
    Microseconds exposureMin{0}, exposureMax{0};
    Nanoseconds framePeriod{0};
    int maxFrames = 1;
    Ident ident;
    Limits limits;
};

struct CaptureRequest {
    std::uint64_t planStep = 0;  ///< capture_id = plan step << 16 | attempt
    std::optional<int> led{};    ///< empty: dark
    LedLevels levels{};          ///< all zero: dark, whatever `led` says
    Microseconds exposure{1000};
    double gainDb = 0;
    int frames = 1;
    bool keepLit = true;  ///< false: dark at the end too
};

/// Exactly the frames asked for, in order of their index, and what it took to get them.
struct Capture {
    std::vector<Frame> frames;
    Anomalies anomalies;
    int discarded = 0;   ///< frames from before the settings took effect
    int resends = 0;     ///< RESEND commands
    int recaptures = 0;  ///< captures taken again after RESEND was not enough

    [[nodiscard]] std::size_t size() const { return frames.size(); }
    [[nodiscard]] const Frame& front() const { return frames.front(); }
    [[nodiscard]] const Frame& operator[](std::size_t i) const { return frames[i]; }
    [[nodiscard]] auto begin() const { return frames.begin(); }
    [[nodiscard]] auto end() const { return frames.end(); }
};

class Rig {
public:
    /// `transport` is borrowed and must outlive the rig.
    static Result<Rig> open(Transport& transport, const LinkOptions& options);
    static Result<Rig> open(Transport& transport, std::uint64_t sessionId);
    Rig(Rig&&) noexcept = default;
    Rig& operator=(Rig&&) = delete;
    ~Rig();

    [[nodiscard]] RigInfo identify() const;
    /// The window that is read from now on. Taken exactly, or an error.
    Result<void> configure(const Window& window, PixelFormat format = PixelFormat::Mono12Packed);
    Result<Capture> capture(const CaptureRequest& request);
    /// All LEDs dark.
    Result<void> darken();
    Result<void> keepAlive() { return link_->keepAlive(); }
    Result<Status> status() { return link_->freshStatus(); }
    /// Dark, and given back. Nothing but identify() works afterwards.
    Result<void> close();

    /// Since the rig was opened.
    [[nodiscard]] const Anomalies& anomalies() const { return assembler_.anomalies(); }
    [[nodiscard]] RigLink& link() { return *link_; }

private:
    struct Geometry {
        Window window;
        PixelFormat format = PixelFormat::Mono12Packed;
        std::uint32_t frameBytes = 0;
    };
    struct Progress;  // of one capture, over all its attempts

    explicit Rig(std::unique_ptr<RigLink> link) : link_(std::move(link)) {}
    Result<void> start();
    [[nodiscard]] Result<void> check(const CaptureRequest& request) const;
    Result<void> fill(const CaptureRequest& request, Progress& progress);
    Result<void> attempt(const CaptureRequest& request, Progress& progress);
    Result<FramePlan> apply(const CaptureRequest& request);
    Result<void> arm(std::uint64_t planStep, int frames);
    Result<void> collect(const FramePlan& plan, Progress& progress);
    void accept(const WireFrame& wire, const FramePlan& plan, Progress& progress);
    Result<void> askAgain(const MissingChunks& chunks, Progress& progress);
    Result<void> quiesce();
    Result<void> flush();
    void makeSafe();
    [[nodiscard]] Nanoseconds patience(const Exposure& exposure) const;

    std::unique_ptr<RigLink> link_;  ///< empty after a move
    Assembler assembler_;
    std::optional<Geometry> geometry_;
    std::uint64_t lastStep_ = 0;
    std::uint16_t lastAttempt_ = 0;
};

}  // namespace gonio::driver
