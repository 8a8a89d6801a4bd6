#pragma once
// The frames of one capture, from their chunks (PROTOCOL.md 3). What goes in: chunks of this
// capture, of a sound header at least. What comes out: frames of which every chunk is there and
// both CRC levels agree, and what is known to be lost (to be asked for again). A frame's memory is
// taken when its first sound chunk comes, exactly frameBytes, and never for more frames than may be
// held, nor than kMaxOpenBytes hold: then the oldest unfinished frame is given up. Nothing else is
// allocated for chunks as they come, nor to begin a capture for which there is room: the records of
// one capture are used again for the next. Whether a frame is what was planned is frame_plan.h's
// business.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "driver/anomalies.h"
#include "driver/frame_memory.h"
#include "driver/protocol/chunk.h"

namespace gonio::driver {

/// The capture that is wanted, and what IDENT and SET_FORMAT said of its frames.
struct ExpectedCapture {
    std::uint32_t bootId = 0;
    std::uint64_t captureId = 0;
    int frames = 0;
    std::uint32_t frameBytes = 0;
    std::uint32_t maxChunkPayload = 0;
    /// Frames that may wait for their chunks or their reader at once; 0: all.
    int held = 0;
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
    [[nodiscard]] static Result<void> check(const ExpectedCapture& capture);
    /// Nothing of the present capture may be left: giveBack(). Precondition: check().
    void begin(const ExpectedCapture& capture);
    /// begin() will not allocate for `capture`. Precondition: check().
    void makeRoom(const ExpectedCapture& capture);
    [[nodiscard]] bool hasRoomFor(const ExpectedCapture& capture) const;

    [[nodiscard]] bool owns(const ChunkHeader& header) const;
    /// Frames that may be held at once: so many buffers should wait.
    [[nodiscard]] std::size_t most() const { return most_; }
    /// Takes the payload of a chunk that it owns; true when it was new. Anomalies are counted.
    bool place(const Chunk& chunk, Anomalies& anomalies, WireMemory& memory);
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
    void askedFor(const MissingChunks& chunks);
    /// Ends it all: its memory is for others, its records are for the next capture.
    void giveBack(WireMemory& memory);

    /// The first ABORTED.
    [[nodiscard]] const std::optional<Aborted>& aborted() const { return aborted_; }

private:
    struct OpenFrame {
        std::vector<std::uint8_t> bytes;  ///< empty before its first chunk
        std::vector<bool> have;           ///< by chunk_index: leader, data, trailer
        std::size_t missing = 0;
        Leader leader;
        Trailer trailer;
        bool ended = false;
        std::optional<std::uint16_t> awaited;  ///< the last chunk asked for
    };

    [[nodiscard]] static std::size_t chunksOf(const ExpectedCapture& capture);
    [[nodiscard]] static std::size_t mostOf(const ExpectedCapture& capture);
    [[nodiscard]] bool fits(const ChunkHeader& header) const;
    [[nodiscard]] std::size_t dataLength(std::size_t chunkIndex) const;
    using OpenFrames = std::map<int, OpenFrame>;

    [[nodiscard]] static OpenFrames::node_type freshNode(std::size_t chunks);
    OpenFrame& open(int frame);
    void close(OpenFrames::iterator frame);
    bool hold(OpenFrame& frame, Anomalies& anomalies, WireMemory& memory);
    bool store(OpenFrame& frame, const Chunk& chunk);
    void finish(int index, Anomalies& anomalies);

    ExpectedCapture expected_;
    std::uint16_t chunkCount_ = 0;  ///< DATA chunks per frame; 0: of no capture
    std::size_t most_ = 0;
    OpenFrames open_;
    std::vector<OpenFrames::node_type> spares_;  ///< for frames that begin; never more than before
    std::size_t mostChunks_ = 0;                 ///< for so many DATA chunks each
    std::vector<bool> finished_;
    std::vector<WireFrame> ready_;
    std::optional<Aborted> aborted_;
    bool over_ = false;
};

}  // namespace gonio::driver
