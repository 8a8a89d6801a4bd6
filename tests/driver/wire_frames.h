#pragma once
// Small frames as a rig would send them, for tests that break them.

#include <cstdint>
#include <vector>

#include "driver/protocol/chunk.h"
#include "driver/protocol/crc.h"
#include "driver/protocol/pixels.h"

namespace gonio::driver::test {

using Bytes = std::vector<std::uint8_t>;

inline constexpr std::uint32_t kBoot = 0xB0071D01;
inline constexpr std::uint32_t kPayload = 16;  ///< max_chunk_payload: many chunks in a small frame

/// Pixel values that differ from frame to frame.
inline Image<std::uint16_t> picture(Size size, int seed) {
    Image<std::uint16_t> image(size);
    unsigned value = 60U + static_cast<unsigned>(seed) * 97U;
    for (auto& pixel : image.pixels()) pixel = static_cast<std::uint16_t>(value += 31) & 0xFFFU;
    return image;
}

struct FrameToSend {
    std::uint64_t captureId = 0x50001;
    int index = 0;
    Leader leader{};    ///< geometry and frame_bytes are filled in
    Trailer trailer{};  ///< frame_bytes and frame_crc are filled in
    Image<std::uint16_t> pixels{};
    std::uint32_t bootId = kBoot;
};

/// LEADER, DATA..., TRAILER with stream_seq from `sequence` on.
inline std::vector<Bytes> toChunks(FrameToSend frame, std::uint32_t sequence) {
    const Bytes data = packPixels(frame.pixels, frame.leader.format);
    const auto bytes = static_cast<std::uint32_t>(data.size());
    frame.leader.width = static_cast<std::uint16_t>(frame.pixels.width());
    frame.leader.height = static_cast<std::uint16_t>(frame.pixels.height());
    frame.leader.stride = *strideOf(frame.leader.format, frame.pixels.width());
    frame.leader.frameBytes = bytes;
    frame.trailer.frameBytes = bytes;
    frame.trailer.frameCrc = crc32c(data);
    const std::uint32_t count = (bytes + kPayload - 1) / kPayload;
    ChunkHeader header{.type = ChunkType::Leader,
                       .bootId = frame.bootId,
                       .streamSequence = sequence,
                       .captureId = frame.captureId,
                       .frameIndex = static_cast<std::uint16_t>(frame.index),
                       .chunkCount = static_cast<std::uint16_t>(count)};
    std::vector<Bytes> chunks{encodeChunk(header, encode(frame.leader))};
    header.type = ChunkType::Data;
    for (std::uint32_t offset = 0; offset < bytes; offset += kPayload) {
        ++header.streamSequence;
        ++header.chunkIndex;
        header.offset = offset;
        const std::size_t length = std::min(kPayload, bytes - offset);
        chunks.push_back(encodeChunk(header, std::span(data).subspan(offset, length)));
    }
    header.type = ChunkType::Trailer;
    header.offset = 0;
    ++header.streamSequence;
    ++header.chunkIndex;
    chunks.push_back(encodeChunk(header, encode(frame.trailer)));
    return chunks;
}

}  // namespace gonio::driver::test
