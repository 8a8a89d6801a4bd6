#include "driver/assembler.h"

#include <utility>

namespace gonio::driver {
namespace {

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

void Assembler::forget() {
    present_.giveBack(memory_);
    next_.giveBack(memory_);
    bootId_.reset();
}

void Assembler::makeRoom(const ExpectedCapture& largest) {
    forget();
    if (!CaptureFrames::check(largest)) return;
    present_.makeRoom(largest);
    next_.makeRoom(largest);
}

Result<void> Assembler::expect(const ExpectedCapture& capture) {
    forget();
    if (auto sound = CaptureFrames::check(capture); !sound) return sound;
    present_.begin(capture);
    memory_.provide(capture.frameBytes, present_.most());
    bootId_ = capture.bootId;
    return {};
}

Result<void> Assembler::expectNext(const ExpectedCapture& capture) {
    if (auto sound = CaptureFrames::check(capture); !sound) return sound;
    next_.giveBack(memory_);
    next_.begin(capture);
    return {};
}

void Assembler::moveOn() {
    present_.giveBack(memory_);
    std::swap(present_, next_);
}

void Assembler::flushed(std::uint32_t nextStreamSequence) {
    sequence_ = nextStreamSequence;
    floor_ = nextStreamSequence;
}

bool Assembler::feed(std::span<const std::uint8_t> transfer) {
    const CheckedChunk seen = checkChunk(transfer);
    count(anomalies_, seen.fault);
    if (!headerHolds(seen.fault)) return false;
    const ChunkHeader& header = seen.chunk.header;
    if (bootId_ != header.bootId || beforeFlush(header.streamSequence)) {
        ++anomalies_.stale;
        return false;
    }
    follow(header.streamSequence);
    const bool ofPresent = present_.owns(header);
    if (!ofPresent && !next_.owns(header)) {
        ++anomalies_.stale;
        return false;
    }
    CaptureFrames& frames = ofPresent ? present_ : next_;
    const bool fresh =
        seen.fault == ChunkFault::None && frames.place(seen.chunk, anomalies_, memory_);
    const bool inTurn = frames.passed(header);
    if (!ofPresent && inTurn) present_.ended();
    return ofPresent && fresh;
}

/// The first chunk at or past the flush ends the waiting, so that a later wrap is not held back.
bool Assembler::beforeFlush(std::uint32_t streamSequence) {
    if (!floor_) return false;
    if (ahead(streamSequence, *floor_) < 0) return true;
    floor_.reset();
    return false;
}

void Assembler::follow(std::uint32_t streamSequence) {
    const std::int32_t jump = sequence_ ? ahead(streamSequence, *sequence_) : 0;
    if (jump < 0) {
        ++anomalies_.disordered;
        return;
    }
    anomalies_.lostChunks += static_cast<std::uint32_t>(jump);
    sequence_ = streamSequence + 1;
}

}  // namespace gonio::driver
