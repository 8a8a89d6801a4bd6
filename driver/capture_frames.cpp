#include "driver/capture_frames.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "driver/protocol/crc.h"

namespace gonio::driver {

std::size_t CaptureFrames::chunksOf(const ExpectedCapture& capture) {
    const std::size_t payload = capture.maxChunkPayload;
    return payload == 0 ? 0 : (capture.frameBytes + payload - 1) / payload;
}

std::size_t CaptureFrames::mostOf(const ExpectedCapture& capture) {
    const auto all = static_cast<std::size_t>(capture.frames);
    const auto held = capture.held > 0 ? static_cast<std::size_t>(capture.held) : all;
    return std::min({all, held, kMaxOpenBytes / capture.frameBytes});
}

Result<void> CaptureFrames::check(const ExpectedCapture& capture) {
    const std::size_t chunks = chunksOf(capture);
    // The trailer's chunk_index is chunks + 1, and 65535 means "to the end" in RESEND.
    constexpr std::size_t kMaxChunks = std::numeric_limits<std::uint16_t>::max() - 2;
    constexpr int kMaxFrames = std::numeric_limits<std::uint16_t>::max();
    const bool sound = chunks > 0 && chunks <= kMaxChunks && capture.frameBytes <= kMaxOpenBytes &&
                       capture.frames >= 1 && capture.frames <= kMaxFrames;
    if (sound) return {};
    return Error{ErrorKind::Device,
                 "capture " + std::to_string(capture.captureId) + ": " +
                     std::to_string(capture.frames) + " frames of " +
                     std::to_string(capture.frameBytes) + " bytes in chunks of " +
                     std::to_string(capture.maxChunkPayload) + " cannot be assembled"};
}

void CaptureFrames::makeRoom(const ExpectedCapture& capture) {
    const std::size_t most = mostOf(capture), chunks = chunksOf(capture);
    finished_.reserve(static_cast<std::size_t>(capture.frames));
    ready_.reserve(most);
    spares_.reserve(most);
    if (chunks > mostChunks_) spares_.clear();
    mostChunks_ = std::max(mostChunks_, chunks);
    while (open_.size() + spares_.size() < most) spares_.push_back(freshNode(mostChunks_));
}

bool CaptureFrames::hasRoomFor(const ExpectedCapture& capture) const {
    const std::size_t most = mostOf(capture);
    return finished_.capacity() >= static_cast<std::size_t>(capture.frames) &&
           ready_.capacity() >= most && open_.size() + spares_.size() >= most &&
           mostChunks_ >= chunksOf(capture);
}

void CaptureFrames::begin(const ExpectedCapture& capture) {
    makeRoom(capture);
    expected_ = capture;
    chunkCount_ = static_cast<std::uint16_t>(chunksOf(capture));
    most_ = mostOf(capture);
    finished_.assign(static_cast<std::size_t>(capture.frames), false);
}

bool CaptureFrames::owns(const ChunkHeader& header) const {
    return chunkCount_ != 0 && header.bootId == expected_.bootId &&
           header.captureId == expected_.captureId;
}

std::size_t CaptureFrames::dataLength(std::size_t chunkIndex) const {
    const std::size_t before = (chunkIndex - 1) * std::size_t{expected_.maxChunkPayload};
    return std::min<std::size_t>(expected_.maxChunkPayload, expected_.frameBytes - before);
}

/// Index, count, offset and length as the frame's size demands them.
bool CaptureFrames::fits(const ChunkHeader& header) const {
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

bool CaptureFrames::place(const Chunk& chunk, Anomalies& anomalies, WireMemory& memory) {
    const ChunkHeader& header = chunk.header;
    if (header.type < ChunkType::Leader || header.type > ChunkType::Aborted) {
        ++anomalies.unknownTypes;
        return false;
    }
    if (!fits(header)) {
        ++anomalies.contradictions;
        return false;
    }
    if (header.type == ChunkType::Aborted) {
        ++anomalies.aborted;
        const Result<Aborted> aborted = decodeAborted(chunk.payload);
        if (aborted && !aborted_) aborted_ = *aborted;
        return false;
    }
    const auto begun = open_.find(header.frameIndex);
    if (finished(header.frameIndex) ||
        (begun != open_.end() && begun->second.have[header.chunkIndex])) {
        if (!header.resent) ++anomalies.duplicates;
        return false;
    }
    OpenFrame& frame = open(header.frameIndex);
    if (frame.bytes.empty() && !hold(frame, anomalies, memory)) return false;
    if (!store(frame, chunk)) {
        ++anomalies.badFrames;
        return false;
    }
    frame.have[header.chunkIndex] = true;
    if (--frame.missing == 0) finish(header.frameIndex, anomalies);
    return true;
}

/// The record of a frame with room for which of its chunks are there.
CaptureFrames::OpenFrames::node_type CaptureFrames::freshNode(std::size_t chunks) {
    OpenFrames one;
    one[0].have.reserve(chunks + 2);
    return one.extract(one.begin());
}

CaptureFrames::OpenFrame& CaptureFrames::open(int frame) {
    const auto found = open_.find(frame);
    if (found != open_.end()) return found->second;
    // Asked for, with no chunk of it here.
    if (spares_.empty()) spares_.push_back(freshNode(mostChunks_));
    OpenFrames::node_type node = std::move(spares_.back());
    spares_.pop_back();
    node.key() = frame;
    OpenFrame& fresh = open_.insert(std::move(node)).position->second;
    fresh.missing = std::size_t{chunkCount_} + 2;
    fresh.have.assign(fresh.missing, false);
    return fresh;
}

/// As freshNode() made it, for another frame.
void CaptureFrames::close(OpenFrames::iterator frame) {
    OpenFrames::node_type node = open_.extract(frame);
    node.mapped() = {.have = std::move(node.mapped().have)};
    if (spares_.size() < spares_.capacity()) spares_.push_back(std::move(node));
}

/// False: all that may be held is whole, and waits for its reader.
bool CaptureFrames::hold(OpenFrame& frame, Anomalies& anomalies, WireMemory& memory) {
    const auto holds = [](const auto& each) { return !each.second.bytes.empty(); };
    std::size_t held =
        ready_.size() + static_cast<std::size_t>(std::count_if(open_.begin(), open_.end(), holds));
    for (; held >= most_; --held) {
        ++anomalies.givenUp;
        const auto oldest = std::find_if(open_.begin(), open_.end(), holds);
        if (oldest == open_.end()) return false;
        memory.giveBack(std::move(oldest->second.bytes));
        close(oldest);
    }
    frame.bytes = memory.take();
    frame.bytes.resize(expected_.frameBytes);
    return true;
}

bool CaptureFrames::store(OpenFrame& frame, const Chunk& chunk) {
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
bool CaptureFrames::passed(const ChunkHeader& header) {
    if (!fits(header)) return false;
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
    return !header.resent;
}

void CaptureFrames::finish(int index, Anomalies& anomalies) {
    OpenFrame& frame = open_.at(index);
    if (crc32c(frame.bytes) != frame.trailer.frameCrc) {
        // Sound chunks that do not make the frame: nothing of it can be believed.
        ++anomalies.badFrames;
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
    close(open_.find(index));
}

std::optional<WireFrame> CaptureFrames::take() {
    if (ready_.empty()) return std::nullopt;
    WireFrame frame = std::move(ready_.front());
    ready_.erase(ready_.begin());
    return frame;
}

bool CaptureFrames::finished(int frame) const {
    return frame >= 0 && static_cast<std::size_t>(frame) < finished_.size() &&
           finished_[static_cast<std::size_t>(frame)];
}

std::optional<MissingChunks> CaptureFrames::missing(int frame) const {
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

std::vector<MissingChunks> CaptureFrames::lost() const {
    std::vector<MissingChunks> all;
    for (const auto& [index, frame] : open_) {
        const bool over = frame.ended || (over_ && !frame.awaited);
        if (const auto chunks = missing(index); over && chunks) all.push_back(*chunks);
    }
    for (int i = 0; over_ && i < expected_.frames; ++i) {
        if (!begun(i)) all.push_back(*missing(i));
    }
    return all;
}

void CaptureFrames::askedFor(const MissingChunks& chunks) {
    if (chunks.frame < 0 || chunks.frame >= expected_.frames || finished(chunks.frame)) return;
    OpenFrame& frame = open(chunks.frame);
    frame.ended = false;
    frame.awaited = chunks.last;
}

void CaptureFrames::giveBack(WireMemory& memory) {
    for (WireFrame& frame : ready_) memory.giveBack(std::move(frame.bytes));
    ready_.clear();
    while (!open_.empty()) {
        memory.giveBack(std::move(open_.begin()->second.bytes));
        close(open_.begin());
    }
    finished_.clear();
    expected_ = {};
    chunkCount_ = 0;
    most_ = 0;
    aborted_.reset();
    over_ = false;
}

}  // namespace gonio::driver
