#include "sim/frame_chunks.h"

#include <algorithm>

namespace gonio::sim {

using namespace driver;

std::vector<std::vector<std::uint8_t>> frameChunks(ChunkHeader header,
                                                   const Leader& leader,
                                                   std::span<const std::uint8_t> pixels,
                                                   const Trailer& trailer,
                                                   std::uint32_t payload) {
    const std::size_t count = (pixels.size() + payload - 1) / payload;
    header.chunkCount = static_cast<std::uint16_t>(count);
    std::vector<std::vector<std::uint8_t>> chunks;
    header.type = ChunkType::Leader;
    chunks.push_back(encodeChunk(header, encode(leader)));
    for (std::size_t i = 0; i < count; ++i) {
        header.type = ChunkType::Data;
        header.chunkIndex = static_cast<std::uint16_t>(i + 1);
        header.offset = static_cast<std::uint32_t>(i * payload);
        const std::size_t left = pixels.size() - header.offset;
        const std::size_t length = std::min<std::size_t>(payload, left);
        chunks.push_back(encodeChunk(header, pixels.subspan(header.offset, length)));
    }
    header.type = ChunkType::Trailer;
    header.chunkIndex = static_cast<std::uint16_t>(count + 1);
    header.offset = 0;
    chunks.push_back(encodeChunk(header, encode(trailer)));
    return chunks;
}

}  // namespace gonio::sim
