#pragma once
// The way of the frames to the host: chunks that wait to be sent, numbered in the order in which
// they were queued, and the frame RAM, from which chunks are sent again (PROTOCOL.md 2, RESEND).

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "driver/protocol/reports.h"

namespace gonio::sim {

/// Frames that are kept for RESEND; as many may wait to be sent, and as many to be sent again.
inline constexpr std::size_t kFrameRam = 8;

class FrameQueue {
public:
    struct Frame {
        std::uint64_t capture = 0;
        int index = 0;
        std::vector<std::vector<std::uint8_t>> chunks;
    };
    /// Queues its chunks and keeps it; the oldest is forgotten.
    void add(Frame frame);
    void add(std::vector<std::uint8_t> chunk, bool resent = false);
    /// Queues them once more. Status FRAME_GONE, BAD_RANGE, BUSY (more would wait to be sent again
    /// than the RAM holds: later) or OK, and how many there were.
    struct Resent {
        std::uint16_t status = 0;
        std::uint32_t chunks = 0;
    };
    Resent resend(const driver::Resend& wanted);

    [[nodiscard]] std::optional<std::vector<std::uint8_t>> take();
    /// Nothing waits any more; the frame RAM stays.
    void flush() {
        waiting_.clear();
        resentWaiting_ = 0;
    }
    void forgetFrames() { ram_.clear(); }

    [[nodiscard]] bool holds(std::uint64_t capture) const;
    [[nodiscard]] std::size_t framesWaiting() const;
    [[nodiscard]] std::uint32_t nextSequence() const { return nextSequence_; }

private:
    std::deque<Frame> ram_;
    struct Waiting {
        std::vector<std::uint8_t> chunk;
        bool resent = false;
    };
    std::deque<Waiting> waiting_;
    std::size_t resentWaiting_ = 0;
    std::uint32_t nextSequence_ = 1;
};

}  // namespace gonio::sim
