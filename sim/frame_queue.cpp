#include "sim/frame_queue.h"

#include <algorithm>
#include <utility>

#include "driver/protocol/chunk.h"

namespace gonio::sim {

using namespace driver;  // the wire's words

namespace {

constexpr std::size_t kTypeByte = 5;  // of a chunk's header

bool isTrailer(const std::vector<std::uint8_t>& chunk) {
    return chunk[kTypeByte] == static_cast<std::uint8_t>(ChunkType::Trailer);
}

}  // namespace

void FrameQueue::add(Frame frame) {
    for (const auto& chunk : frame.chunks) add(chunk);
    ram_.push_back(std::move(frame));
    if (ram_.size() > kFrameRam) ram_.pop_front();
}

void FrameQueue::add(std::vector<std::uint8_t> chunk, bool resent) {
    restamp(chunk, nextSequence_++, resent);
    waiting_.push_back({.chunk = std::move(chunk), .resent = resent});
    resentWaiting_ += resent ? 1 : 0;
}

FrameQueue::Resent FrameQueue::resend(const Resend& wanted) {
    const auto frame = std::find_if(ram_.begin(), ram_.end(), [&](const Frame& f) {
        return f.capture == wanted.captureId && f.index == wanted.frame;
    });
    if (frame == ram_.end()) return {.status = status::kFrameGone};
    const std::size_t last =
        wanted.lastChunk == 0xFFFF ? frame->chunks.size() - 1 : wanted.lastChunk;
    if (wanted.firstChunk > last || last >= frame->chunks.size()) {
        return {.status = status::kBadRange};
    }
    if (resentWaiting_ + (last - wanted.firstChunk + 1) > kFrameRam * frame->chunks.size())
        return {.status = status::kBusy};
    for (std::size_t i = wanted.firstChunk; i <= last; ++i) add(frame->chunks[i], true);
    return {.status = status::kOk,
            .chunks = static_cast<std::uint32_t>(last - wanted.firstChunk + 1)};
}

std::optional<std::vector<std::uint8_t>> FrameQueue::take() {
    if (waiting_.empty()) return std::nullopt;
    Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    resentWaiting_ -= next.resent ? 1 : 0;
    return std::move(next.chunk);
}

bool FrameQueue::holds(std::uint64_t capture) const {
    return std::any_of(
        ram_.begin(), ram_.end(), [&](const Frame& f) { return f.capture == capture; });
}

std::size_t FrameQueue::framesWaiting() const {
    return static_cast<std::size_t>(std::count_if(
        waiting_.begin(), waiting_.end(), [](const Waiting& one) { return isTrailer(one.chunk); }));
}

}  // namespace gonio::sim
