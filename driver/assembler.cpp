#include "driver/assembler.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "driver/protocol/crc.h"

namespace gonio::driver {
namespace {

struct Counter {
    std::uint32_t Anomalies::*count;
    const char* one;
    const char* many;
};

constexpr std::array kCounters{
    Counter{&Anomalies::emptyTransfers, "empty transfer", "empty transfers"},
    Counter{&Anomalies::badLengths, "bad length", "bad lengths"},
    Counter{&Anomalies::badHeaders, "bad header", "bad headers"},
    Counter{&Anomalies::badPayloads, "bad payload", "bad payloads"},
    Counter{&Anomalies::badFrames, "bad frame", "bad frames"},
    Counter{&Anomalies::lostChunks, "lost chunk", "lost chunks"},
    Counter{&Anomalies::disordered, "chunk out of order", "chunks out of order"},
    Counter{&Anomalies::duplicates, "duplicate", "duplicates"},
    Counter{&Anomalies::stale, "stale chunk", "stale chunks"},
    Counter{&Anomalies::unknownTypes, "unknown chunk type", "unknown chunk types"},
    Counter{&Anomalies::contradictions, "contradicting chunk", "contradicting chunks"},
    Counter{&Anomalies::aborted, "aborted frame", "aborted frames"},
    Counter{&Anomalies::givenUp, "frame given up", "frames given up"},
};

// stream_seq wraps: the nearer way round says which of two is older.
std::int32_t ahead(std::uint32_t sequence, std::uint32_t of) {
    return static_cast<std::int32_t>(sequence - of);
}

bool headerHolds(ChunkFault fault) {
    return fault == ChunkFault::None || fault == ChunkFault::Length ||
           fault == ChunkFault::PayloadCrc;
}

void count(Anomalies& anomalies, ChunkFault fault) {
    switch (fault) {
        case ChunkFault::None: return;
        case ChunkFault::Empty: ++anomalies.emptyTransfers; return;
        case ChunkFault::Short:
        case ChunkFault::Length: ++anomalies.badLengths; return;
        case ChunkFault::Magic:
        case ChunkFault::HeaderCrc:
        case ChunkFault::Version: ++anomalies.badHeaders; return;
        case ChunkFault::PayloadCrc: ++anomalies.badPayloads; return;
    }
}

}  // namespace

std::uint32_t Anomalies::total() const {
    std::uint32_t sum = 0;
    for (const Counter& c : kCounters) sum += this->*c.count;
    return sum;
}

Anomalies Anomalies::since(const Anomalies& before) const {
    Anomalies fresh;
    for (const Counter& c : kCounters) fresh.*c.count = this->*c.count - before.*c.count;
    return fresh;
}

std::string Anomalies::text() const {
    std::string list;
    for (const Counter& c : kCounters) {
        const std::uint32_t n = this->*c.count;
        if (n == 0) continue;
        if (!list.empty()) list += ", ";
        list += std::to_string(n) + " " + (n == 1 ? c.one : c.many);
    }
    return list.empty() ? "none" : list;
}

Result<void> Assembler::expect(const ExpectedCapture& capture) {
    expected_ = {};
    chunkCount_ = 0;
    open_.clear();
    ready_.clear();
    finished_.clear();
    aborted_.reset();
    const std::uint64_t payload = capture.maxChunkPayload;
    const std::uint64_t chunks =
        payload == 0 ? 0 : (std::uint64_t{capture.frameBytes} + payload - 1) / payload;
    // The trailer's chunk_index is chunks + 1, and 65535 means "to the end" in RESEND.
    constexpr std::uint64_t kMaxChunks = std::numeric_limits<std::uint16_t>::max() - 2;
    constexpr int kMaxFrames = std::numeric_limits<std::uint16_t>::max();
    if (chunks == 0 || chunks > kMaxChunks || capture.frameBytes > kMaxOpenBytes ||
        capture.frames < 1 || capture.frames > kMaxFrames) {
        return Error{ErrorKind::Device,
                     "capture " + std::to_string(capture.captureId) + ": " +
                         std::to_string(capture.frames) + " frames of " +
                         std::to_string(capture.frameBytes) + " bytes in chunks of " +
                         std::to_string(capture.maxChunkPayload) + " cannot be assembled"};
    }
    expected_ = capture;
    chunkCount_ = static_cast<std::uint16_t>(chunks);
    finished_.assign(static_cast<std::size_t>(capture.frames), false);
    return {};
}

void Assembler::flushed(std::uint32_t nextStreamSequence) {
    next_ = nextStreamSequence;
    floor_ = nextStreamSequence;
}

bool Assembler::feed(std::span<const std::uint8_t> transfer) {
    const CheckedChunk seen = checkChunk(transfer);
    count(anomalies_, seen.fault);
    if (!headerHolds(seen.fault)) return false;
    const ChunkHeader& header = seen.chunk.header;
    if (chunkCount_ == 0 || header.bootId != expected_.bootId ||
        beforeFlush(header.streamSequence)) {
        ++anomalies_.stale;
        return false;
    }
    follow(header.streamSequence);
    if (header.captureId != expected_.captureId) {
        ++anomalies_.stale;
        return false;
    }
    const bool fresh = seen.fault == ChunkFault::None && place(seen.chunk);
    if (fits(header)) passed(header);
    return fresh;
}

/// The first chunk at or past the flush ends the waiting, so that a later wrap is not held back.
bool Assembler::beforeFlush(std::uint32_t streamSequence) {
    if (!floor_) return false;
    if (ahead(streamSequence, *floor_) < 0) return true;
    floor_.reset();
    return false;
}

void Assembler::follow(std::uint32_t streamSequence) {
    const std::int32_t jump = next_ ? ahead(streamSequence, *next_) : 0;
    if (jump < 0) {
        ++anomalies_.disordered;
        return;
    }
    anomalies_.lostChunks += static_cast<std::uint32_t>(jump);
    next_ = streamSequence + 1;
}

std::size_t Assembler::dataLength(std::size_t chunkIndex) const {
    const std::size_t before = (chunkIndex - 1) * std::size_t{expected_.maxChunkPayload};
    return std::min<std::size_t>(expected_.maxChunkPayload, expected_.frameBytes - before);
}

/// Index, count, offset and length as the frame's size demands them.
bool Assembler::fits(const ChunkHeader& header) const {
    if (header.frameIndex >= expected_.frames) return false;
    if (header.type == ChunkType::Aborted) return header.length >= kAbortedBytes;
    if (header.chunkCount != chunkCount_) return false;
    switch (header.type) {
        case ChunkType::Leader:
            return header.chunkIndex == 0 && header.offset == 0 && header.length >= kLeaderBytes;
        case ChunkType::Trailer:
            return header.chunkIndex == chunkCount_ + 1 && header.offset == 0 &&
                   header.length >= kTrailerBytes;
        case ChunkType::Data: break;
        default: return false;
    }
    return header.chunkIndex >= 1 && header.chunkIndex <= chunkCount_ &&
           header.offset == (header.chunkIndex - 1U) * std::uint64_t{expected_.maxChunkPayload} &&
           header.length == dataLength(header.chunkIndex);
}

bool Assembler::place(const Chunk& chunk) {
    const ChunkHeader& header = chunk.header;
    if (header.type < ChunkType::Leader || header.type > ChunkType::Aborted) {
        ++anomalies_.unknownTypes;
        return false;
    }
    if (!fits(header)) {
        ++anomalies_.contradictions;
        return false;
    }
    if (header.type == ChunkType::Aborted) {
        ++anomalies_.aborted;
        const Result<Aborted> aborted = decodeAborted(chunk.payload);
        if (aborted && !aborted_) aborted_ = *aborted;
        return false;
    }
    const auto begun = open_.find(header.frameIndex);
    if (finished(header.frameIndex) ||
        (begun != open_.end() && begun->second.have[header.chunkIndex])) {
        if (!header.resent) ++anomalies_.duplicates;
        return false;
    }
    OpenFrame& frame = open(header.frameIndex);
    if (!store(frame, chunk)) {
        ++anomalies_.badFrames;
        return false;
    }
    frame.have[header.chunkIndex] = true;
    if (--frame.missing == 0) finish(header.frameIndex);
    return true;
}

Assembler::OpenFrame& Assembler::open(int frame) {
    const auto found = open_.find(frame);
    if (found != open_.end()) return found->second;
    while (!open_.empty() && (open_.size() + 1) * expected_.frameBytes > kMaxOpenBytes) {
        open_.erase(open_.begin());
        ++anomalies_.givenUp;
    }
    OpenFrame& fresh = open_[frame];
    fresh.bytes.resize(expected_.frameBytes);
    fresh.have.assign(std::size_t{chunkCount_} + 2, false);
    fresh.missing = fresh.have.size();
    return fresh;
}

bool Assembler::store(OpenFrame& frame, const Chunk& chunk) {
    if (chunk.header.type == ChunkType::Leader) {
        const Result<Leader> leader = decodeLeader(chunk.payload);
        if (leader) frame.leader = *leader;
        return leader.has_value();
    }
    if (chunk.header.type == ChunkType::Trailer) {
        const Result<Trailer> trailer = decodeTrailer(chunk.payload);
        if (!trailer || trailer->frameBytes != expected_.frameBytes) return false;
        frame.trailer = *trailer;
        return true;
    }
    std::copy(chunk.payload.begin(),
              chunk.payload.end(),
              frame.bytes.begin() + static_cast<std::ptrdiff_t>(chunk.header.offset));
    return true;
}

/// Frames come in order and so do their chunks: what should have come before `header` and is not
/// here is lost. Of chunks asked for again, only the last of them says so.
void Assembler::passed(const ChunkHeader& header) {
    for (auto& [index, frame] : open_) {
        const bool own = index == header.frameIndex;
        if (frame.awaited) {
            if (own && header.resent && header.chunkIndex >= *frame.awaited) {
                frame.awaited.reset();
                frame.ended = true;
            }
        } else if (!header.resent) {
            const bool itsEnd = own && header.type == ChunkType::Trailer;
            frame.ended = frame.ended || itsEnd || index < header.frameIndex;
        }
    }
}

void Assembler::finish(int index) {
    OpenFrame& frame = open_.at(index);
    if (crc32c(frame.bytes) != frame.trailer.frameCrc) {
        // Sound chunks that do not make the frame: nothing of it can be believed.
        ++anomalies_.badFrames;
        frame.have.assign(frame.have.size(), false);
        frame.missing = frame.have.size();
        frame.awaited.reset();
        frame.ended = true;
        return;
    }
    ready_.push_back({.captureId = expected_.captureId,
                      .index = index,
                      .leader = frame.leader,
                      .trailer = frame.trailer,
                      .bytes = std::move(frame.bytes)});
    finished_[static_cast<std::size_t>(index)] = true;
    open_.erase(index);
}

std::optional<WireFrame> Assembler::take() {
    if (ready_.empty()) return std::nullopt;
    WireFrame frame = std::move(ready_.front());
    ready_.pop_front();
    return frame;
}

bool Assembler::finished(int frame) const {
    return frame >= 0 && static_cast<std::size_t>(frame) < finished_.size() &&
           finished_[static_cast<std::size_t>(frame)];
}

std::optional<MissingChunks> Assembler::missing(int frame) const {
    if (frame < 0 || frame >= expected_.frames || finished(frame)) return std::nullopt;
    const auto found = open_.find(frame);
    if (found == open_.end()) {
        return MissingChunks{
            .frame = frame, .first = 0, .last = static_cast<std::uint16_t>(chunkCount_ + 1)};
    }
    const std::vector<bool>& have = found->second.have;
    const auto first = std::find(have.begin(), have.end(), false);
    const auto last = std::find(have.rbegin(), have.rend(), false);
    return MissingChunks{.frame = frame,
                         .first = static_cast<std::uint16_t>(first - have.begin()),
                         .last = static_cast<std::uint16_t>(have.rend() - last - 1)};
}

std::vector<MissingChunks> Assembler::lost() const {
    std::vector<MissingChunks> all;
    for (const auto& [index, frame] : open_) {
        if (const auto chunks = missing(index); frame.ended && chunks) all.push_back(*chunks);
    }
    return all;
}

void Assembler::askedFor(const MissingChunks& chunks) {
    if (chunks.frame < 0 || chunks.frame >= expected_.frames || finished(chunks.frame)) return;
    OpenFrame& frame = open(chunks.frame);
    frame.ended = false;
    frame.awaited = chunks.last;
}

}  // namespace gonio::driver
