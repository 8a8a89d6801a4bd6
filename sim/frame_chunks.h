#pragma once
// A frame as it goes down the bulk stream (PROTOCOL.md 3): LEADER, full DATA chunks and a shorter
// last one, TRAILER.

#include <cstdint>
#include <span>
#include <vector>

#include "driver/protocol/chunk.h"

namespace gonio::sim {

inline constexpr std::uint32_t kMaxChunkPayload = 256 * 1024;  ///< unless a rig says otherwise

/// `header` brings what all chunks of the frame share; type, chunk_index, chunk_count and offset
/// are set here. Of the pixels, a chunk holds `payload` bytes at most.
[[nodiscard]] std::vector<std::vector<std::uint8_t>> frameChunks(
    driver::ChunkHeader header,
    const driver::Leader& leader,
    std::span<const std::uint8_t> pixels,
    const driver::Trailer& trailer,
    std::uint32_t payload = kMaxChunkPayload);

}  // namespace gonio::sim
