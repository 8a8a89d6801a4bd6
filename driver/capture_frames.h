#pragma once
// The frames of one capture, from their chunks (PROTOCOL.md 3). What goes in: chunks of this
// capture, of a sound header at least. What comes out: frames of which every chunk is there and
// both CRC levels agree, and what is known to be lost (to be asked for again). A frame's memory is
// taken when its first sound chunk comes, exactly frameBytes, and never for more frames than
// kMaxOpenBytes hold: then the oldest unfinished frame is given up. Whether a frame is what was
// planned is frame_plan.h's business.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "driver/anomalies.h"
#include "driver/protocol/chunk.h"

namespace gonio::driver {

/// The capture that is wanted, and what IDENT and SET_FORMAT said of its frames.
struct ExpectedCapture {
    std::uint32_t bootId = 0;
    std::uint64_t captureId = 0;
    int frames = 0;
    std::uint32_t frameBytes = 0;
    std::uint32_t maxChunkPayload = 0;
};

/// A frame whole and sound as bytes; its pixels are still packed.
struct WireFrame {
    std::uint64_t captureId = 0;
    int index = 0;
    Leader leader;
    Trailer trailer;
    std::vector<std::uint8_t> bytes;
};

/// Chunks first..last of a frame, inclusive: the smallest range that holds all missing ones.
struct MissingChunks {
    int frame = 0;
    std::uint16_t first = 0, last = 0;
    bool operator==(const MissingChunks&) const = default;
};

class CaptureFrames {
public:
    static constexpr std::size_t kMaxOpenBytes = std::size_t{256} << 20;

    /// Of no capture: every chunk is another's.
    CaptureFrames() = default;
    /// A Device error when the sizes of `capture` cannot be.
    static Result<CaptureFrames> of(const ExpectedCapture& capture);

    [[nodiscard]] bool owns(const ChunkHeader& header) const;
    /// Takes the payload of a chunk that it owns; true when it was new. Anomalies are counted.
    bool place(const Chunk& chunk, Anomalies& anomalies);
    /// A chunk that it owns has passed, its payload sound or not. True when it came in its turn:
    /// one of these frames, and not sent again.
    bool passed(const ChunkHeader& header);
    /// A later capture's chunk has passed: whatever has not come by now is lost.
    void ended() { over_ = true; }

    /// A finished frame, in the order in which they were finished; empty when there is none.
    [[nodiscard]] std::optional<WireFrame> take();
    [[nodiscard]] bool finished(int frame) const;
    /// A chunk of it has come, so that it has been exposed.
    [[nodiscard]] bool begun(int frame) const { return finished(frame) || open_.contains(frame); }
    /// Frames that have ended with chunks missing: what comes after them has come.
    [[nodiscard]] std::vector<MissingChunks> lost() const;
    /// All that an unfinished frame lacks, whether or not it may still come.
    [[nodiscard]] std::optional<MissingChunks> missing(int frame) const;
    /// The chunks have been asked for: the frame is lost again only when the last of them passes.
    void askedFor(const MissingChunks& chunks, Anomalies& anomalies);

    /// The first ABORTED.
    [[nodiscard]] const std::optional<Aborted>& aborted() const { return aborted_; }

private:
    struct OpenFrame {
        std::vector<std::uint8_t> bytes;
        std::vector<bool> have;  ///< by chunk_index: leader, data, trailer
        std::size_t missing = 0;
        Leader leader;
        Trailer trailer;
        bool ended = false;
        std::optional<std::uint16_t> awaited;  ///< the last chunk asked for
    };

    [[nodiscard]] bool fits(const ChunkHeader& header) const;
    [[nodiscard]] std::size_t dataLength(std::size_t chunkIndex) const;
    OpenFrame& open(int frame, Anomalies& anomalies);
    bool store(OpenFrame& frame, const Chunk& chunk);
    void finish(int index, Anomalies& anomalies);

    ExpectedCapture expected_;
    std::uint16_t chunkCount_ = 0;  ///< DATA chunks per frame; 0: of no capture
    std::map<int, OpenFrame> open_;
    std::vector<bool> finished_;
    std::deque<WireFrame> ready_;
    std::optional<Aborted> aborted_;
    bool over_ = false;
};

}  // namespace gonio::driver
