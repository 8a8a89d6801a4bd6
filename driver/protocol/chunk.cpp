#include "driver/protocol/chunk.h"

#include <algorithm>
#include <string>

#include "driver/protocol/crc.h"
#include "driver/protocol/wire.h"

namespace gonio::driver {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{'G', 'N', 'F', '1'};
constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kHeaderCrcOffset = 60;

Error chunkError(const std::string& what) { return {ErrorKind::Device, "chunk: " + what}; }

Error lengthError(const char* name, std::size_t seen, std::size_t wanted) {
    return {ErrorKind::Device,
            std::string(name) + " payload: " + std::to_string(seen) + " bytes, wanted " +
                std::to_string(wanted)};
}

void sealHeader(std::span<std::uint8_t> header) {
    put(header, kHeaderCrcOffset, crc32c(header.first(kHeaderCrcOffset)));
}

template <class Item, std::size_t N>
void putAll(std::span<std::uint8_t> bytes, std::size_t offset, const std::array<Item, N>& items) {
    for (std::size_t i = 0; i < N; ++i) put(bytes, offset + i * sizeof(Item), items[i]);
}

template <class Item, std::size_t N>
void getAll(std::span<const std::uint8_t> bytes, std::size_t offset, std::array<Item, N>& items) {
    for (std::size_t i = 0; i < N; ++i) items[i] = get<Item>(bytes, offset + i * sizeof(Item));
}

}  // namespace

std::vector<std::uint8_t> encodeChunk(ChunkHeader header, std::span<const std::uint8_t> payload) {
    std::vector<std::uint8_t> bytes(kChunkHeaderBytes + payload.size());
    const std::span<std::uint8_t> head = std::span(bytes).first(kChunkHeaderBytes);
    std::copy(kMagic.begin(), kMagic.end(), bytes.begin());
    put(head, 4, kVersion);
    put(head, 5, static_cast<std::uint8_t>(header.type));
    put(head, 6, static_cast<std::uint16_t>(kChunkHeaderBytes));
    put(head, 8, header.bootId);
    put(head, 12, header.streamSequence);
    put(head, 16, header.captureId);
    put(head, 24, header.frameIndex);
    put(head, 26, header.chunkIndex);
    put(head, 28, header.chunkCount);
    put(head, 30, static_cast<std::uint16_t>(header.resent ? 1 : 0));
    put(head, 32, header.offset);
    put(head, 36, static_cast<std::uint32_t>(payload.size()));
    put(head, 40, header.timeUs);
    put(head, 48, payload.empty() ? 0U : crc32c(payload));
    sealHeader(head);
    std::copy(payload.begin(), payload.end(), bytes.begin() + kChunkHeaderBytes);
    return bytes;
}

void restamp(std::vector<std::uint8_t>& chunk, std::uint32_t streamSequence, bool resent) {
    const std::span<std::uint8_t> head = std::span(chunk).first(kChunkHeaderBytes);
    put(head, 12, streamSequence);
    put(head, 30, static_cast<std::uint16_t>(resent ? 1 : 0));
    sealHeader(head);
}

CheckedChunk checkChunk(std::span<const std::uint8_t> transfer) {
    CheckedChunk seen;
    const auto found = [&seen](ChunkFault fault) {
        seen.fault = fault;
        return seen;
    };
    if (transfer.empty()) return found(ChunkFault::Empty);
    if (transfer.size() < kChunkHeaderBytes) return found(ChunkFault::Short);
    if (!std::equal(kMagic.begin(), kMagic.end(), transfer.begin()))
        return found(ChunkFault::Magic);
    if (get<std::uint32_t>(transfer, kHeaderCrcOffset) !=
        crc32c(transfer.first(kHeaderCrcOffset))) {
        return found(ChunkFault::HeaderCrc);
    }
    if (transfer[4] != kVersion) return found(ChunkFault::Version);
    seen.headerBytes = get<std::uint16_t>(transfer, 6);
    ChunkHeader& header = seen.chunk.header;
    header.type = static_cast<ChunkType>(transfer[5]);
    header.bootId = get<std::uint32_t>(transfer, 8);
    header.streamSequence = get<std::uint32_t>(transfer, 12);
    header.captureId = get<std::uint64_t>(transfer, 16);
    header.frameIndex = get<std::uint16_t>(transfer, 24);
    header.chunkIndex = get<std::uint16_t>(transfer, 26);
    header.chunkCount = get<std::uint16_t>(transfer, 28);
    header.resent = (get<std::uint16_t>(transfer, 30) & 1U) != 0;
    header.offset = get<std::uint32_t>(transfer, 32);
    header.length = get<std::uint32_t>(transfer, 36);
    header.timeUs = get<std::uint64_t>(transfer, 40);
    if (seen.headerBytes < kChunkHeaderBytes || seen.headerBytes > transfer.size() ||
        transfer.size() - seen.headerBytes != header.length) {
        return found(ChunkFault::Length);
    }
    const auto payload = transfer.subspan(seen.headerBytes);
    const std::uint32_t crc = payload.empty() ? 0U : crc32c(payload);
    if (get<std::uint32_t>(transfer, 48) != crc) return found(ChunkFault::PayloadCrc);
    seen.chunk.payload = payload;
    return seen;
}

Result<Chunk> decodeChunk(std::span<const std::uint8_t> transfer) {
    const CheckedChunk seen = checkChunk(transfer);
    const std::string bytes = std::to_string(transfer.size()) + " bytes";
    switch (seen.fault) {
        case ChunkFault::None: return seen.chunk;
        case ChunkFault::Empty:
        case ChunkFault::Short: return chunkError(bytes + ", wanted a header of 64");
        case ChunkFault::Magic: return chunkError("no GNF1 magic");
        case ChunkFault::HeaderCrc: return chunkError("header CRC does not agree");
        case ChunkFault::Version:
            return chunkError("version " + std::to_string(transfer[4]) + ", wanted 1");
        case ChunkFault::Length:
            return chunkError(bytes + " came, the header promised " +
                              std::to_string(seen.headerBytes) + " + " +
                              std::to_string(seen.chunk.header.length));
        case ChunkFault::PayloadCrc: return chunkError("payload CRC does not agree");
    }
    return chunkError("unknown fault");
}

std::vector<std::uint8_t> encode(const Leader& v) {
    std::vector<std::uint8_t> bytes(kLeaderBytes);
    const std::span<std::uint8_t> b(bytes);
    put(b, 0, v.width);
    put(b, 2, v.height);
    put(b, 4, v.stride);
    put(b, 8, static_cast<std::uint8_t>(v.format));
    put(b, 9, v.led);
    put(b, 10, v.channels);
    put(b, 11, v.bitDepth);
    put(b, 12, v.exposureRequestedUs);
    put(b, 16, v.exposureGrantedNs);
    put(b, 24, v.gain);
    putAll(b, 26, v.ledLevel);
    putAll(b, 32, v.temperature);
    put(b, 40, v.blackLevel);
    put(b, 42, v.x);
    put(b, 44, v.y);
    put(b, 46, v.binning);
    put(b, 48, v.frameBytes);
    put(b, 52, v.exposureStartUs);
    put(b, 60, v.frameNumber);
    return bytes;
}

Result<Leader> decodeLeader(std::span<const std::uint8_t> b) {
    if (b.size() < kLeaderBytes) return lengthError("LEADER", b.size(), kLeaderBytes);
    Leader v;
    v.width = get<std::uint16_t>(b, 0);
    v.height = get<std::uint16_t>(b, 2);
    v.stride = get<std::uint32_t>(b, 4);
    v.format = static_cast<PixelFormat>(b[8]);
    v.led = b[9];
    v.channels = b[10];
    v.bitDepth = b[11];
    v.exposureRequestedUs = get<std::uint32_t>(b, 12);
    v.exposureGrantedNs = get<std::uint64_t>(b, 16);
    v.gain = get<std::uint16_t>(b, 24);
    getAll(b, 26, v.ledLevel);
    getAll(b, 32, v.temperature);
    v.blackLevel = get<std::uint16_t>(b, 40);
    v.x = get<std::uint16_t>(b, 42);
    v.y = get<std::uint16_t>(b, 44);
    v.binning = b[46];
    v.frameBytes = get<std::uint32_t>(b, 48);
    v.exposureStartUs = get<std::uint64_t>(b, 52);
    v.frameNumber = get<std::uint32_t>(b, 60);
    return v;
}

std::vector<std::uint8_t> encode(const Trailer& v) {
    std::vector<std::uint8_t> bytes(kTrailerBytes);
    const std::span<std::uint8_t> b(bytes);
    put(b, 0, v.frameBytes);
    put(b, 4, v.frameCrc);
    put(b, 8, v.exposureEndUs);
    putAll(b, 16, v.currentMin);
    putAll(b, 22, v.currentMax);
    put(b, 28, v.validity);
    put(b, 32, v.saturatedPixels);
    return bytes;
}

Result<Trailer> decodeTrailer(std::span<const std::uint8_t> b) {
    if (b.size() < kTrailerBytes) return lengthError("TRAILER", b.size(), kTrailerBytes);
    Trailer v;
    v.frameBytes = get<std::uint32_t>(b, 0);
    v.frameCrc = get<std::uint32_t>(b, 4);
    v.exposureEndUs = get<std::uint64_t>(b, 8);
    getAll(b, 16, v.currentMin);
    getAll(b, 22, v.currentMax);
    v.validity = get<std::uint16_t>(b, 28);
    v.saturatedPixels = get<std::uint32_t>(b, 32);
    return v;
}

std::vector<std::uint8_t> encode(const Aborted& v) {
    std::vector<std::uint8_t> bytes(kAbortedBytes);
    put(std::span(bytes), 0, v.reason);
    put(std::span(bytes), 4, v.frameNumber);
    return bytes;
}

Result<Aborted> decodeAborted(std::span<const std::uint8_t> b) {
    if (b.size() < kAbortedBytes) return lengthError("ABORTED", b.size(), kAbortedBytes);
    return Aborted{.reason = get<std::uint16_t>(b, 0), .frameNumber = get<std::uint32_t>(b, 4)};
}

}  // namespace gonio::driver
