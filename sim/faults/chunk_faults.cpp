#include "sim/faults/chunk_faults.h"

#include <algorithm>
#include <utility>

#include "driver/protocol/chunk.h"
#include "driver/protocol/wire.h"
#include "sim/random.h"

namespace gonio::sim {
namespace {

using driver::kChunkHeaderBytes;

constexpr std::size_t kTypeByte = 5, kCaptureAt = 16, kFlagsByte = 30;  // PROTOCOL.md 3

struct Bits {
    std::size_t first = 0, count = 0;
};

void flip(ChunkBytes& chunk, std::size_t bit) {
    chunk[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
}

/// So many different ones of these bits.
void flipSome(ChunkBytes& chunk, const Bits& bits, const DueFault& fault) {
    std::vector<std::size_t> flipped;
    const auto wanted = std::min<std::size_t>(static_cast<std::size_t>(fault.count), bits.count);
    for (std::uint64_t i = 0; flipped.size() < wanted; ++i) {
        const double u = uniform(fault.key, i);
        const auto bit = bits.first + static_cast<std::size_t>(u * static_cast<double>(bits.count));
        if (std::find(flipped.begin(), flipped.end(), bit) != flipped.end()) continue;
        flipped.push_back(bit);
        flip(chunk, bit);
    }
}

/// So many in a row, of which the first and the last change for certain.
void flipBurst(ChunkBytes& chunk, const Bits& bits, const DueFault& fault) {
    const auto length = std::min<std::size_t>(static_cast<std::size_t>(fault.count), bits.count);
    const auto room = static_cast<double>(bits.count - length + 1);
    const auto first = bits.first + static_cast<std::size_t>(uniform(fault.key, 0) * room);
    for (std::size_t i = 0; i < length; ++i) {
        const bool end = i == 0 || i + 1 == length;
        if (end || uniform(fault.key, 1 + i) < 0.5) flip(chunk, first + i);
    }
}

Bits headerBits() { return {.first = 0, .count = 8 * kChunkHeaderBytes}; }
Bits payloadBits(const ChunkBytes& chunk) {
    return {.first = 8 * kChunkHeaderBytes, .count = 8 * (chunk.size() - kChunkHeaderBytes)};
}

bool isType(const ChunkBytes& chunk, driver::ChunkType type) {
    return chunk.size() > kTypeByte && chunk[kTypeByte] == static_cast<std::uint8_t>(type);
}

/// At least the header stays, at least a byte goes.
std::size_t shortened(std::size_t size, std::uint64_t key) {
    const auto room = static_cast<double>(size - kChunkHeaderBytes);
    return kChunkHeaderBytes + static_cast<std::size_t>(uniform(key, 0) * room);
}

}  // namespace

bool spoilsChunks(FaultKind kind) {
    switch (kind) {
        case FaultKind::StallBulk:
        case FaultKind::BreakTransfer:
        case FaultKind::Overflow:
        case FaultKind::ShortenChunk:
        case FaultKind::LengthenChunk:
        case FaultKind::EmptyPacket:
        case FaultKind::FlipPayload:
        case FaultKind::FlipHeader:
        case FaultKind::BurstPayload:
        case FaultKind::LoseChunk:
        case FaultKind::DuplicateChunk:
        case FaultKind::SwapChunks:
        case FaultKind::StaleFrame: return true;
        default: return false;
    }
}

std::optional<ChunkBytes> ChunkFaults::ready() {
    if (ready_.empty()) return std::nullopt;
    ChunkBytes chunk = std::move(ready_.front());
    ready_.pop_front();
    return chunk;
}

UsbAnswer ChunkFaults::answer() { return std::exchange(answer_, UsbAnswer::Nak); }

void ChunkFaults::clear() {
    ready_.clear();
    answer_ = UsbAnswer::Nak;
}

std::optional<ChunkBytes> ChunkFaults::through(ChunkBytes chunk,
                                               const UsbDevice::ChunkSource& next) {
    if (remembers_) remember(chunk);
    Sent sent;
    sent.chunk = std::move(chunk);
    std::deque<DueFault> left;
    while (!waiting_.empty()) {
        DueFault fault = std::move(waiting_.front());
        waiting_.pop_front();
        if (!sent.chunk || !spoil(fault, sent, next)) {
            left.push_back(std::move(fault));
            continue;
        }
        tally_.add(fault.kind);
        const bool flips = fault.kind == FaultKind::FlipPayload ||
                           fault.kind == FaultKind::FlipHeader ||
                           fault.kind == FaultKind::BurstPayload;
        if (!flips && --fault.count > 0) left.push_back(std::move(fault));
    }
    waiting_ = std::move(left);
    for (auto& before : sent.before) ready_.push_back(std::move(before));
    if (sent.chunk) ready_.push_back(std::move(*sent.chunk));
    for (auto& after : sent.after) ready_.push_back(std::move(after));
    return ready();
}

bool ChunkFaults::spoil(const DueFault& fault, Sent& sent, const UsbDevice::ChunkSource& next) {
    ChunkBytes& chunk = *sent.chunk;
    const bool whole = chunk.size() > kChunkHeaderBytes;
    switch (fault.kind) {
        case FaultKind::StallBulk: answer_ = UsbAnswer::Stall; break;
        case FaultKind::BreakTransfer: answer_ = UsbAnswer::Error; break;
        case FaultKind::Overflow: answer_ = UsbAnswer::Overflow; break;
        case FaultKind::LoseChunk: break;
        case FaultKind::ShortenChunk:
            if (!whole) return false;
            chunk.resize(shortened(chunk.size(), fault.key));
            return true;
        case FaultKind::LengthenChunk: chunk.resize(chunk.size() + 1); return true;
        case FaultKind::EmptyPacket: sent.before.emplace_back(); return true;
        case FaultKind::FlipHeader:
            if (!whole) return false;
            flipSome(chunk, headerBits(), fault);
            return true;
        case FaultKind::FlipPayload:
            if (!whole) return false;
            flipSome(chunk, payloadBits(chunk), fault);
            return true;
        case FaultKind::BurstPayload:
            if (!whole) return false;
            flipBurst(chunk, payloadBits(chunk), fault);
            return true;
        case FaultKind::DuplicateChunk: sent.after.push_back(chunk); return true;
        case FaultKind::SwapChunks: {
            auto follower = next();
            if (!follower) return false;
            sent.before.push_back(std::move(*follower));
            return true;
        }
        case FaultKind::StaleFrame:
            if (earlier_.chunks.empty()) return false;
            for (const ChunkBytes& old : earlier_.chunks) sent.before.push_back(old);
            return true;
        default: return true;
    }
    sent.chunk.reset();
    return true;
}

/// Whole frames as they were first sent.
void ChunkFaults::remember(const ChunkBytes& chunk) {
    if (chunk.size() < kChunkHeaderBytes || (chunk[kFlagsByte] & 1) != 0) return;
    const auto capture = driver::get<std::uint64_t>(chunk, kCaptureAt);
    if (latest_.capture != capture && !latest_.chunks.empty()) {
        earlier_ = std::exchange(latest_, {});
    }
    if (isType(chunk, driver::ChunkType::Leader)) recording_ = {.capture = capture, .chunks = {}};
    recording_.chunks.push_back(chunk);
    if (isType(chunk, driver::ChunkType::Trailer)) latest_ = std::exchange(recording_, {});
}

}  // namespace gonio::sim
