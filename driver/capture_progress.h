#pragma once
// How far a capture has come, over all its attempts: the frames that are there, what has been asked
// for again, what is hopeless in this attempt, and why. A frame that is there stays.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "driver/frame_memory.h"
#include "proc/core/frame.h"
#include "proc/core/result.h"

namespace gonio::driver {

/// Looks at a frame; its error ends the capture. A sink that moves the frame (its parameter may be
/// a Frame) keeps it; one that does not (const Frame&) leaves the memory to the next frame.
using FrameSink = std::function<Result<void>(Frame&&)>;

class CaptureProgress {
public:
    CaptureProgress() = default;
    /// At most `held` frames wait to be delivered; 0: all.
    explicit CaptureProgress(int frames, int held = 0) { start(frames, held); }
    /// As a new one, in the memory of the last.
    void start(int frames, int held);
    /// start() and begin() will not allocate for so many frames.
    void makeRoom(int frames);
    [[nodiscard]] bool hasRoom(int frames) const;

    /// A new attempt: what was hopeless may be hoped for again.
    void begin();
    /// Wanted, and still to be hoped for in this attempt.
    [[nodiscard]] bool waitsFor(int frame) const;
    [[nodiscard]] bool waits() const;
    /// Nothing is wrong with this attempt, and no frame before `frame` is waited for.
    [[nodiscard]] bool soundUpTo(int frame) const;
    /// This attempt lost or refused a frame.
    [[nodiscard]] bool failed() const { return failed_; }
    /// Frames up to the last one that is missing: those must be armed again; 0 when all are there.
    [[nodiscard]] int toArm() const;

    /// There is memory to keep it until all before it are there.
    [[nodiscard]] bool hasRoomFor(int frame) const;
    void keep(Frame frame);
    /// From before the settings took effect: to be taken again, though nobody failed.
    void discard(int frame);
    void giveUp(int frame, const std::string& why);
    /// The link was lost and is there again: what was asked for before does not count.
    void interrupt();
    /// Lost with the link: to be taken again, though nobody failed.
    void redo(int frame) { hopeless_[static_cast<std::size_t>(frame)] = true; }
    /// In this attempt.
    [[nodiscard]] bool interrupted() const { return interrupted_; }
    /// Counts a RESEND for `frame`; false when it has had `most` in this attempt.
    [[nodiscard]] bool mayAskAgain(int frame, int most);

    /// The first reasons of those that were given, as a list.
    [[nodiscard]] const std::string& evidence() const { return evidence_; }
    /// Hands over the frames that are there, in the order of their index, up to the first that is
    /// missing. They count as there ever after; what the sink leaves goes into `memory`.
    [[nodiscard]] Result<void> deliver(const FrameSink& sink, PixelMemory& memory);
    /// Those that were not delivered. Precondition: toArm() == 0.
    [[nodiscard]] std::vector<Frame> takeFrames();

    int discarded = 0, resends = 0, recaptures = 0;

private:
    /// Whether it is there, and itself until it is delivered.
    struct Place {
        bool there = false;
        std::optional<Frame> frame{};
    };
    std::vector<Place> frames_;
    int most_ = 0, held_ = 0;
    std::size_t delivered_ = 0;   ///< so many of the first
    std::vector<int> asked_;      ///< RESENDs of this attempt, by frame
    std::vector<bool> hopeless_;  ///< of this attempt, by frame
    bool failed_ = false, interrupted_ = false;
    int reasons_ = 0;
    std::string evidence_;
};

}  // namespace gonio::driver
