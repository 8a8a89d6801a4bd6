#pragma once
// What may go wrong on the bulk stream (PROTOCOL.md 3), counted.

#include <cstdint>
#include <string>

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

}  // namespace gonio::driver
