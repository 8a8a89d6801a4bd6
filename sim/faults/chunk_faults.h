#pragma once
// What goes wrong with chunks on their way: a filter between the rig and its bulk endpoint. A fault
// waits here for the chunks that it is to spoil.

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "sim/faults/fault_player.h"
#include "sim/usb_device.h"

namespace gonio::sim {

/// How often each fault has really happened.
class FaultTally {
public:
    void add(FaultKind kind) { ++counts_[static_cast<std::size_t>(kind)]; }
    [[nodiscard]] int of(FaultKind kind) const { return counts_[static_cast<std::size_t>(kind)]; }

private:
    std::array<int, kFaultKinds> counts_{};
};

using ChunkBytes = std::vector<std::uint8_t>;

[[nodiscard]] bool spoilsChunks(FaultKind kind);

class ChunkFaults {
public:
    explicit ChunkFaults(FaultTally& tally) : tally_(tally) {}

    /// It meets the next chunk, or as many as it counts.
    void put(DueFault fault) { waiting_.push_back(std::move(fault)); }
    /// Frames are remembered from now on, so that one can come again.
    void rememberFrames() { remembers_ = true; }

    /// What was put in front of the chunk to come; empty: nothing.
    [[nodiscard]] std::optional<ChunkBytes> ready();
    /// A chunk as it is sent, after what was put in front of it; `next` gives the one after it.
    /// Empty: it is lost, and answer() says whether its transfer ends in an error.
    [[nodiscard]] std::optional<ChunkBytes> through(ChunkBytes chunk,
                                                    const UsbDevice::ChunkSource& next);
    /// How the transfer ends that got no chunk; Nak: it goes on waiting.
    [[nodiscard]] UsbAnswer answer();
    [[nodiscard]] bool failed() const { return answer_ != UsbAnswer::Nak; }
    /// The cable was pulled, or the stream flushed: what was on its way is lost.
    void clear();

private:
    struct Sent {
        std::optional<ChunkBytes> chunk;
        std::deque<ChunkBytes> before, after;
    };
    /// False: the fault has to wait for another chunk.
    bool spoil(const DueFault& fault, Sent& sent, const UsbDevice::ChunkSource& next);
    void remember(const ChunkBytes& chunk);

    struct Remembered {
        std::uint64_t capture = 0;
        std::vector<ChunkBytes> chunks;
    };
    FaultTally& tally_;
    std::deque<DueFault> waiting_;
    std::deque<ChunkBytes> ready_;
    UsbAnswer answer_ = UsbAnswer::Nak;
    bool remembers_ = false;
    Remembered recording_, latest_, earlier_;
};

}  // namespace gonio::sim
