#pragma once
// From bulk transfers to the frames of the captures that are wanted (PROTOCOL.md 3). What goes in:
// transfers as they come, sound or not. What comes out: the present capture's frames
// (capture_frames.h), and a count of every anomaly. A next capture may be expected beside it, whose
// frames come while the present one's are still repaired: a chunk of it in its turn says that
// whatever the present one lacks is lost. Before expect(): every chunk is stale. The memory of the
// present one's frames waits here from expect() on, and is used again once it is given back; so
// are the records of captures, one after the other.

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "driver/capture_frames.h"

namespace gonio::driver {

class Assembler {
public:
    /// Forgets all frames and waits for those of `capture`; counters and the place in the stream
    /// stay. A Device error when its sizes cannot be: nothing is then expected.
    Result<void> expect(const ExpectedCapture& capture);
    /// Waits for those of `capture` too. An error as above: the present capture is not touched.
    Result<void> expectNext(const ExpectedCapture& capture);
    /// The next capture is the present one from now on, with all that has come of it.
    void moveOn();
    void forgetNext() { next_.giveBack(memory_); }
    /// Has memory for `frames` of `bytes` wait, beside what frames hold already.
    void provide(std::size_t bytes, std::size_t frames) { memory_.provide(bytes, frames); }
    /// Forgets all, and keeps records for two captures like `largest`, the present and the next,
    /// which will then be expected without allocating. Sizes that cannot be are left to expect().
    void makeRoom(const ExpectedCapture& largest);
    /// expectNext() will allocate nothing, and `frames` of both captures may be held at once.
    [[nodiscard]] bool hasRoomForNext(const ExpectedCapture& next, std::size_t frames) const {
        return next_.hasRoomFor(next) && memory_.most(next.frameBytes) >= frames;
    }
    /// After FLUSH: older chunks are stale, and the jump to `nextStreamSequence` is no loss.
    void flushed(std::uint32_t nextStreamSequence);

    /// True when the transfer brought something new of the present capture.
    bool feed(std::span<const std::uint8_t> transfer);

    // Of the present capture, as in CaptureFrames.
    [[nodiscard]] std::optional<WireFrame> take() { return present_.take(); }
    /// The frame has been read: its memory is for the next.
    void giveBack(WireFrame&& frame) { memory_.giveBack(std::move(frame.bytes)); }
    [[nodiscard]] bool finished(int frame) const { return present_.finished(frame); }
    [[nodiscard]] bool begun(int frame) const { return present_.begun(frame); }
    [[nodiscard]] std::vector<MissingChunks> lost() const { return present_.lost(); }
    [[nodiscard]] std::optional<MissingChunks> missing(int frame) const {
        return present_.missing(frame);
    }
    void askedFor(const MissingChunks& chunks) { present_.askedFor(chunks); }
    [[nodiscard]] const std::optional<Aborted>& aborted() const { return present_.aborted(); }

    [[nodiscard]] const Anomalies& anomalies() const { return anomalies_; }

private:
    void forget();
    void follow(std::uint32_t streamSequence);
    [[nodiscard]] bool beforeFlush(std::uint32_t streamSequence);

    std::optional<std::uint32_t> bootId_;  ///< empty: nothing is expected
    CaptureFrames present_, next_;
    WireMemory memory_;
    std::optional<std::uint32_t> sequence_;  ///< stream_seq of the next chunk
    std::optional<std::uint32_t> floor_;     ///< after a FLUSH: the first that is not stale
    Anomalies anomalies_;
};

}  // namespace gonio::driver
