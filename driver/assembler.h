#pragma once
// From bulk transfers to frames (PROTOCOL.md 3). What goes in: transfers as they come, sound or
// not. What comes out: frames of the expected capture of which every chunk is there and both CRC
// levels agree, what is known to be lost (to be asked for again), and a count of every anomaly.
// Before expect(): every chunk is stale. A frame's memory is taken when its first sound chunk
// comes, exactly frameBytes, and never for more frames than kMaxOpenBytes hold: then the oldest
// unfinished frame is given up. Whether a frame is what was planned is frame_plan.h's business.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "driver/protocol/chunk.h"

namespace gonio::driver {

/// How often something came that should not have.
struct Anomalies {
    std::uint32_t emptyTransfers = 0;  ///< a zero-length packet on its own
    std::uint32_t badLengths = 0;      ///< shorter or longer than the header promised
    std::uint32_t badHeaders = 0;      ///< no magic, wrong version or header CRC
    std::uint32_t badPayloads = 0;     ///< payload CRC
    std::uint32_t badFrames = 0;   ///< frame CRC over sound chunks, or the trailer's frame_bytes
    std::uint32_t lostChunks = 0;  ///< gaps in stream_seq, in chunks
    std::uint32_t disordered = 0;  ///< stream_seq went back or stood still
    std::uint32_t duplicates = 0;  ///< chunks that were there already, resends excepted
    std::uint32_t stale = 0;       ///< of another boot or capture, or from before a flush
    std::uint32_t unknownTypes = 0;
    std::uint32_t contradictions = 0;  ///< sound chunks that do not fit the frame expected
    std::uint32_t aborted = 0;         ///< ABORTED chunks of the expected capture
    std::uint32_t givenUp = 0;         ///< unfinished frames dropped for their memory

    [[nodiscard]] std::uint32_t total() const;
    /// Those that have come since `before`.
    [[nodiscard]] Anomalies since(const Anomalies& before) const;
    /// "2 bad payloads, 1 lost chunk"; "none".
    [[nodiscard]] std::string text() const;
    bool operator==(const Anomalies&) const = default;
};

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

class Assembler {
public:
    static constexpr std::size_t kMaxOpenBytes = std::size_t{256} << 20;

    /// Forgets all frames and waits for those of `capture`; counters and the place in the stream
    /// stay. A Device error when its sizes cannot be: nothing is then expected.
    Result<void> expect(const ExpectedCapture& capture);
    /// After FLUSH: older chunks are stale, and the jump to `nextStreamSequence` is no loss.
    void flushed(std::uint32_t nextStreamSequence);
    /// After SET_INTERFACE, a halt or a re-claim: whatever comes next is in sequence.
    void streamRestarted() { next_.reset(); }

    /// True when the transfer brought something new of the expected capture.
    bool feed(std::span<const std::uint8_t> transfer);

    /// A finished frame, in the order in which they were finished; empty when there is none.
    [[nodiscard]] std::optional<WireFrame> take();
    [[nodiscard]] bool finished(int frame) const;
    /// Frames that have begun and ended with chunks missing: what comes after them has come.
    [[nodiscard]] std::vector<MissingChunks> lost() const;
    /// All that an unfinished frame lacks, whether or not it may still come.
    [[nodiscard]] std::optional<MissingChunks> missing(int frame) const;
    /// The chunks have been asked for: the frame is lost again only when the last of them passes.
    void askedFor(const MissingChunks& chunks);

    /// The first ABORTED of this capture.
    [[nodiscard]] const std::optional<Aborted>& aborted() const { return aborted_; }
    [[nodiscard]] const Anomalies& anomalies() const { return anomalies_; }

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

    void follow(std::uint32_t streamSequence);
    [[nodiscard]] bool beforeFlush(std::uint32_t streamSequence);
    [[nodiscard]] bool fits(const ChunkHeader& header) const;
    [[nodiscard]] std::size_t dataLength(std::size_t chunkIndex) const;
    bool place(const Chunk& chunk);
    OpenFrame& open(int frame);
    bool store(OpenFrame& frame, const Chunk& chunk);
    void passed(const ChunkHeader& header);
    void finish(int index);

    ExpectedCapture expected_;
    std::uint16_t chunkCount_ = 0;  ///< DATA chunks per frame; 0: nothing is expected
    std::map<int, OpenFrame> open_;
    std::vector<bool> finished_;
    std::deque<WireFrame> ready_;
    std::optional<Aborted> aborted_;
    std::optional<std::uint32_t> next_;   ///< stream_seq of the next chunk
    std::optional<std::uint32_t> floor_;  ///< after a FLUSH: the first that is not stale
    Anomalies anomalies_;
};

}  // namespace gonio::driver
