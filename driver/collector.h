#pragma once
// Collects the frames of a capture that the rig has been armed with, and asks again for chunks that
// were lost (at most twice per frame). A frame that stays incomplete, that came from before the
// settings took effect, or that is not what was planned is given up: whether to arm again is the
// rig's business (rig.h). Every wait has a deadline.

#include <cstdint>
#include <functional>

#include "driver/assembler.h"
#include "driver/capture_progress.h"
#include "driver/frame_plan.h"
#include "driver/link.h"

namespace gonio::driver {

/// What the rig was armed with.
struct ArmedCapture {
    ExpectedCapture expected;
    FramePlan plan;
};

class Collector {
public:
    /// All are borrowed. `assembler` expects the capture already.
    Collector(RigLink& link, Assembler& assembler, PixelMemory& pixels)
        : link_(link), assembler_(assembler), pixels_(pixels) {}

    /// Until every frame that `progress` waits for is there or given up. `arrived` is called after
    /// any of them may have come, and before the end. `exposed` is called once, when the rig has
    /// exposed the last frame and all before it are there: the rig is then idle (its chunks are
    /// queued after the exposure), however much is still to be sent. It is not called in an attempt
    /// that fails. An error of the link or of the rig, or of either, ends it.
    Result<void> collect(const ArmedCapture& armed,
                         CaptureProgress& progress,
                         const std::function<Result<void>()>& exposed,
                         const std::function<Result<void>()>& arrived);

    /// Frames that the rig still holds, and those that it does not.
    struct Held {
        int held = 0, gone = 0;
    };
    /// After the link was lost and nothing is on its way: asks for all that `progress` waits for.
    /// What is gone is given up, which is no fault of the rig.
    Result<Held> askForAll(const ArmedCapture& armed, CaptureProgress& progress);

private:
    void takeFinished(const FramePlan& plan, CaptureProgress& progress);
    void weigh(const WireFrame& wire, const FramePlan& plan, CaptureProgress& progress);
    Result<void> repair(const ArmedCapture& armed, CaptureProgress& progress);
    [[nodiscard]] std::vector<MissingChunks> overdue(int frames) const;
    Result<void> askAgain(const MissingChunks& chunks,
                          std::uint64_t captureId,
                          CaptureProgress& progress);
    Result<void> resend(const MissingChunks& chunks, std::uint64_t captureId);
    [[nodiscard]] bool canResend() const;
    [[nodiscard]] Result<void> notAborted() const;
    [[nodiscard]] Nanoseconds patience(const Exposure& exposure) const;

    RigLink& link_;
    Assembler& assembler_;
    PixelMemory& pixels_;
    Nanoseconds deadline_{0};  ///< of the next new chunk
};

}  // namespace gonio::driver
