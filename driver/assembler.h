#pragma once
// Chunks to frames. It takes bulk transfers of one capture and gives back each
// frame whose chunks are all there, once, with both levels of CRC agreeing; it
// counts everything else and says what is missing. It does not judge what a
// frame was taken with: that is the rig's business.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "driver/protocol/chunk.h"

namespace gonio::driver {

/// Everything that was not as it should be, since the start.
struct Anomalies {
    std::uint32_t badChunks = 0;  ///< header, length or CRC wrong, or a stray empty transfer
    std::uint32_t unknownTypes = 0;
    std::uint32_t strangers = 0;  ///< another boot or capture
    std::uint32_t duplicates = 0;
    std::uint32_t sequenceGaps = 0;  ///< chunks lost, by stream_seq
    std::uint32_t badFrames = 0;     ///< complete but inconsistent, or frame CRC wrong
    std::uint32_t abortedFrames = 0;
    std::uint32_t resends = 0;     ///< RESENDs asked for
    std::uint32_t recaptures = 0;  ///< captures taken again
    bool operator==(const Anomalies&) const = default;
};

/// A frame as it came: pixels still packed.
struct RawFrame {
    int index = 0;
    Leader leader;
    Trailer trailer;
    std::vector<std::uint8_t> pixels;
};

/// Chunks of a frame that have not come, first..last inclusive.
struct MissingChunks {
    std::uint16_t frame = 0;
    std::uint16_t first = 0;
    std::uint16_t last = 0;
};

class Assembler {
public:
    /// `largestFrame`: frames of more bytes are refused before anything is
    /// allocated.
    Assembler(std::uint32_t bootId, std::uint32_t maxChunkPayload, std::uint32_t largestFrame);

    /// Frames of this capture are wanted from now on; what came of others is
    /// dropped.
    void expect(std::uint64_t captureId);
    /// The stream was flushed: a gap in stream_seq before the next chunk is no
    /// loss.
    void streamFlushed() { lastSequence_.reset(); }

    /// One bulk transfer. A frame when this completes one.
    [[nodiscard]] std::optional<RawFrame> add(std::span<const std::uint8_t> transfer);

    /// What is missing of frame `index`; empty when nothing of it has come yet.
    [[nodiscard]] std::optional<MissingChunks> missing(int index) const;
    /// The reason of an ABORTED frame of this capture, if one came.
    [[nodiscard]] std::optional<Aborted> aborted() const { return aborted_; }

    [[nodiscard]] const Anomalies& anomalies() const { return anomalies_; }
    [[nodiscard]] Anomalies& anomalies() { return anomalies_; }

private:
    struct Partial {
        std::uint16_t chunkCount = 0;
        std::optional<Leader> leader;
        std::optional<Trailer> trailer;
        std::vector<bool> have;  // DATA chunks 1..chunkCount
        std::vector<std::uint8_t> pixels;
    };

    void watchSequence(const ChunkHeader& header);
    void addLeader(Partial& partial, const Chunk& chunk);
    void addData(Partial& partial, const Chunk& chunk);
    [[nodiscard]] bool consistent(const Partial& partial) const;
    [[nodiscard]] static bool complete(const Partial& partial);

    std::uint32_t bootId_;
    std::uint32_t maxChunkPayload_;
    std::uint32_t largestFrame_;
    std::uint64_t captureId_ = 0;
    std::optional<std::uint32_t> lastSequence_;
    std::map<int, Partial> partials_;
    std::vector<bool> delivered_;
    std::optional<Aborted> aborted_;
    Anomalies anomalies_;
};

}  // namespace gonio::driver
