#include "driver/assembler.h"

#include <algorithm>

#include "driver/protocol/crc.h"

namespace gonio::driver {

Assembler::Assembler(std::uint32_t bootId,
                     std::uint32_t maxChunkPayload,
                     std::uint32_t largestFrame)
    : bootId_(bootId), maxChunkPayload_(maxChunkPayload), largestFrame_(largestFrame) {}

void Assembler::expect(std::uint64_t captureId) {
    captureId_ = captureId;
    partials_.clear();
    delivered_.clear();
    aborted_.reset();
}

void Assembler::watchSequence(const ChunkHeader& header) {
    if (lastSequence_) {
        const std::uint32_t gap = header.streamSequence - *lastSequence_ - 1;
        if (gap != 0 && gap < 0x80000000U) anomalies_.sequenceGaps += gap;
    }
    lastSequence_ = header.streamSequence;
}

std::optional<RawFrame> Assembler::add(std::span<const std::uint8_t> transfer) {
    const Result<Chunk> chunk = decodeChunk(transfer);
    if (!chunk) {
        ++anomalies_.badChunks;
        return std::nullopt;
    }
    const ChunkHeader& header = chunk->header;
    if (header.bootId != bootId_) {
        ++anomalies_.strangers;
        return std::nullopt;
    }
    watchSequence(header);
    if (header.captureId != captureId_) {
        ++anomalies_.strangers;
        return std::nullopt;
    }
    const std::size_t index = header.frameIndex;
    if (header.type == ChunkType::Aborted) {
        ++anomalies_.abortedFrames;
        if (const auto aborted = decodeAborted(chunk->payload)) aborted_ = *aborted;
        partials_.erase(header.frameIndex);
        return std::nullopt;
    }
    if (header.type != ChunkType::Leader && header.type != ChunkType::Data &&
        header.type != ChunkType::Trailer) {
        ++anomalies_.unknownTypes;
        return std::nullopt;
    }
    if (index < delivered_.size() && delivered_[index]) {
        ++anomalies_.duplicates;
        return std::nullopt;
    }
    const std::uint64_t most =
        (std::uint64_t{largestFrame_} + maxChunkPayload_ - 1) / maxChunkPayload_;
    if (header.chunkCount == 0 || header.chunkCount > most) {
        ++anomalies_.badChunks;
        return std::nullopt;
    }
    Partial& partial = partials_[header.frameIndex];
    if (partial.chunkCount == 0) {
        partial.chunkCount = header.chunkCount;
        partial.have.resize(header.chunkCount);
        partial.pixels.resize(std::size_t{header.chunkCount} * maxChunkPayload_);
    }
    if (partial.chunkCount != header.chunkCount) {
        ++anomalies_.badChunks;
        return std::nullopt;
    }
    switch (header.type) {
        case ChunkType::Leader: addLeader(partial, *chunk); break;
        case ChunkType::Data: addData(partial, *chunk); break;
        default: {
            if (partial.trailer) ++anomalies_.duplicates;
            const auto trailer = decodeTrailer(chunk->payload);
            if (trailer && header.chunkIndex == header.chunkCount + 1) {
                partial.trailer = *trailer;
            } else {
                ++anomalies_.badChunks;
            }
        }
    }
    if (!complete(partial)) return std::nullopt;
    const bool good = consistent(partial);
    RawFrame frame{.index = header.frameIndex,
                   .leader = *partial.leader,
                   .trailer = *partial.trailer,
                   .pixels = std::move(partial.pixels)};
    frame.pixels.resize(std::min<std::size_t>(frame.pixels.size(), frame.leader.frameBytes));
    partials_.erase(header.frameIndex);
    if (!good || crc32c(frame.pixels) != frame.trailer.frameCrc) {
        ++anomalies_.badFrames;
        return std::nullopt;
    }
    if (delivered_.size() <= index) delivered_.resize(index + 1);
    delivered_[index] = true;
    return frame;
}

void Assembler::addLeader(Partial& partial, const Chunk& chunk) {
    const auto leader = decodeLeader(chunk.payload);
    if (!leader || chunk.header.chunkIndex != 0) {
        ++anomalies_.badChunks;
        return;
    }
    if (partial.leader) ++anomalies_.duplicates;
    partial.leader = *leader;
}

void Assembler::addData(Partial& partial, const Chunk& chunk) {
    const ChunkHeader& header = chunk.header;
    const bool last = header.chunkIndex == header.chunkCount;
    const bool inRange = header.chunkIndex >= 1 && header.chunkIndex <= header.chunkCount;
    const bool placed =
        inRange && header.offset == (header.chunkIndex - 1U) * std::uint64_t{maxChunkPayload_};
    const bool sized = header.length >= 1 && header.length <= maxChunkPayload_ &&
                       (last || header.length == maxChunkPayload_);
    if (!placed || !sized) {
        ++anomalies_.badChunks;
        return;
    }
    if (partial.have[header.chunkIndex - 1U]) {
        ++anomalies_.duplicates;
        return;
    }
    std::copy(chunk.payload.begin(),
              chunk.payload.end(),
              partial.pixels.begin() + static_cast<std::ptrdiff_t>(header.offset));
    partial.have[header.chunkIndex - 1U] = true;
}

bool Assembler::complete(const Partial& partial) {
    return partial.leader && partial.trailer &&
           std::all_of(partial.have.begin(), partial.have.end(), [](bool have) { return have; });
}

bool Assembler::consistent(const Partial& partial) const {
    const std::uint32_t bytes = partial.leader->frameBytes;
    const std::uint64_t count = (std::uint64_t{bytes} + maxChunkPayload_ - 1) / maxChunkPayload_;
    return bytes > 0 && bytes <= largestFrame_ && bytes == partial.trailer->frameBytes &&
           count == partial.chunkCount &&
           std::uint64_t{partial.leader->stride} * partial.leader->height == bytes;
}

std::optional<MissingChunks> Assembler::missing(int index) const {
    const auto found = partials_.find(index);
    if (found == partials_.end()) return std::nullopt;
    const Partial& partial = found->second;
    // The whole span between the first and the last gap: one RESEND.
    std::optional<std::uint16_t> first;
    std::uint16_t last = 0;
    const auto lacks = [&](std::uint16_t chunk) {
        if (!first) first = chunk;
        last = chunk;
    };
    if (!partial.leader) lacks(0);
    for (std::uint16_t i = 0; i < partial.chunkCount; ++i) {
        if (!partial.have[i]) lacks(static_cast<std::uint16_t>(i + 1));
    }
    if (!partial.trailer) lacks(static_cast<std::uint16_t>(partial.chunkCount + 1));
    if (!first) return std::nullopt;
    return MissingChunks{.frame = static_cast<std::uint16_t>(index), .first = *first, .last = last};
}

}  // namespace gonio::driver
