#pragma once
// The bulk stream of GRP/1: one USB transfer is one chunk, a 64-byte header and its payload.
// Decoders check magic, version, lengths and CRCs and say which was wrong; whether a chunk belongs
// to the frame that is wanted is the assembler's business.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/protocol/constants.h"
#include "proc/core/result.h"

namespace gonio::driver {

inline constexpr std::size_t kChunkHeaderBytes = 64;
inline constexpr std::size_t kLeaderBytes = 64;
inline constexpr std::size_t kTrailerBytes = 64;
inline constexpr std::size_t kAbortedBytes = 8;

enum class ChunkType : std::uint8_t {
    Leader = 1,
    Data = 2,
    Trailer = 3,
    Aborted = 4
};

struct ChunkHeader {
    ChunkType type = ChunkType::Data;  ///< may hold an unknown number: skipped and counted
    std::uint32_t bootId = 0;
    std::uint32_t streamSequence = 0;
    std::uint64_t captureId = 0;
    std::uint16_t frameIndex = 0;
    std::uint16_t chunkIndex = 0;
    std::uint16_t chunkCount = 0;  ///< DATA chunks of the frame
    bool resent = false;
    std::uint32_t offset = 0;
    std::uint32_t length = 0;
    std::uint64_t timeUs = 0;
    bool operator==(const ChunkHeader&) const = default;
};

struct Chunk {
    ChunkHeader header;
    std::span<const std::uint8_t> payload;  ///< borrowed from the transfer
};

/// What is wrong with a transfer as a chunk.
enum class ChunkFault : std::uint8_t {
    None,
    Empty,       ///< a zero-length packet on its own
    Short,       ///< no room for a header
    Magic,       ///< not a chunk
    HeaderCrc,   ///< nothing in the header can be believed
    Version,     ///< of the header
    Length,      ///< more or fewer bytes than the header promised
    PayloadCrc,  ///< the header is sound, its payload is not
};

/// A transfer as far as it can be believed: the header after None, Length and PayloadCrc, the
/// payload after None only.
struct CheckedChunk {
    ChunkFault fault = ChunkFault::None;
    std::size_t headerBytes = 0;  ///< header_len
    Chunk chunk;
};

struct Leader {
    std::uint16_t width = 0, height = 0;  ///< as sent, after binning
    std::uint32_t stride = 0;
    PixelFormat format = PixelFormat::Mono12Packed;
    std::uint8_t led = kDarkLed;
    std::uint8_t channels = 0;  ///< bit0 R, bit1 G, bit2 B: level not 0
    std::uint8_t bitDepth = 12;
    std::uint32_t exposureRequestedUs = 0;
    std::uint64_t exposureGrantedNs = 0;
    std::uint16_t gain = 0;
    std::array<std::uint16_t, 3> ledLevel{};
    std::array<std::int16_t, 4> temperature{};
    std::uint16_t blackLevel = 0;
    std::uint16_t x = 0, y = 0;
    std::uint8_t binning = 1;
    std::uint32_t frameBytes = 0;
    std::uint64_t exposureStartUs = 0;
    std::uint32_t frameNumber = 0;
    bool operator==(const Leader&) const = default;
};

struct Trailer {
    std::uint32_t frameBytes = 0;
    std::uint32_t frameCrc = 0;
    std::uint64_t exposureEndUs = 0;
    std::array<std::uint16_t, 3> currentMin{}, currentMax{};  ///< 0.1 mA
    std::uint16_t validity = 0;
    std::uint32_t saturatedPixels = 0;
    bool operator==(const Trailer&) const = default;
};

struct Aborted {
    std::uint16_t reason = 0;
    std::uint32_t frameNumber = 0;
    bool operator==(const Aborted&) const = default;
};

/// One whole transfer; `header.length` is taken from the payload.
[[nodiscard]] std::vector<std::uint8_t> encodeChunk(ChunkHeader header,
                                                    std::span<const std::uint8_t> payload);
/// Gives an encoded chunk a new place in the stream, as the device does when it sends or resends
/// it.
void restamp(std::vector<std::uint8_t>& chunk, std::uint32_t streamSequence, bool resent);
[[nodiscard]] CheckedChunk checkChunk(std::span<const std::uint8_t> transfer);
/// As checkChunk; device errors: "chunk: ..." with what was wrong.
[[nodiscard]] Result<Chunk> decodeChunk(std::span<const std::uint8_t> transfer);

[[nodiscard]] std::vector<std::uint8_t> encode(const Leader& v);
[[nodiscard]] std::vector<std::uint8_t> encode(const Trailer& v);
[[nodiscard]] std::vector<std::uint8_t> encode(const Aborted& v);
[[nodiscard]] Result<Leader> decodeLeader(std::span<const std::uint8_t> payload);
[[nodiscard]] Result<Trailer> decodeTrailer(std::span<const std::uint8_t> payload);
[[nodiscard]] Result<Aborted> decodeAborted(std::span<const std::uint8_t> payload);

}  // namespace gonio::driver
