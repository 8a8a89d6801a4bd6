#include "driver/collector.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace gonio::driver {
namespace {

using namespace std::chrono_literals;

constexpr int kResends = 2;                    // per frame; PROTOCOL.md 3, "Repair"
constexpr std::uint32_t kCanResend = 1U << 2;  // capability bit

bool isGone(const Error& error) {
    return error.deviceStatus == status::kFrameGone || error.deviceStatus == status::kBadRange;
}

/// So much is waiting to be sent that the rig takes no more.
bool isFull(const Error& error) { return error.deviceStatus == status::kBusy; }

}  // namespace

Result<void> Collector::collect(const ArmedCapture& armed,
                                CaptureProgress& progress,
                                const std::function<Result<void>()>& exposed,
                                const std::function<Result<void>()>& arrived) {
    const Nanoseconds wait = patience(armed.plan.exposure);
    const int last = armed.expected.frames - 1;
    bool told = false;
    deadline_ = link_.clock().now() + wait;
    while (true) {
        takeFinished(armed.plan, progress);
        if (auto sound = notAborted(); !sound) return sound;
        if (!told && assembler_.begun(last) && progress.soundUpTo(last)) {
            told = true;
            if (auto done = exposed(); !done) return done;
            deadline_ = link_.clock().now() + wait;  // the chunks have come meanwhile, unread
        }
        const Nanoseconds idle = link_.clock().now();
        if (auto heard = arrived(); !heard) return heard;
        deadline_ += link_.clock().now() - idle;  // nothing was read meanwhile: nothing is late
        if (auto asked = repair(armed, progress); !asked) return asked;
        if (!progress.waits()) return {};
        const Nanoseconds left = std::max(Nanoseconds{0}, deadline_ - link_.clock().now());
        const auto transfer = link_.readBulk(left);
        if (!transfer) return transfer.error();
        if (*transfer && assembler_.feed(**transfer)) deadline_ = link_.clock().now() + wait;
    }
}

void Collector::takeFinished(const FramePlan& plan, CaptureProgress& progress) {
    while (std::optional<WireFrame> wire = assembler_.take()) {
        if (progress.waitsFor(wire->index)) weigh(*wire, plan, progress);
        assembler_.giveBack(std::move(*wire));
    }
}

void Collector::weigh(const WireFrame& wire, const FramePlan& plan, CaptureProgress& progress) {
    if (!progress.hasRoomFor(wire.index))
        return progress.giveUp(wire.index, "no memory to keep it until those before it are there");
    Image<std::uint16_t> memory = pixels_.take();
    Verdict verdict = judge(wire, plan, memory);
    if (auto* frame = std::get_if<Frame>(&verdict)) return progress.keep(std::move(*frame));
    pixels_.giveBack(std::move(memory));
    if (const auto* rejected = std::get_if<Rejected>(&verdict)) {
        progress.giveUp(wire.index, rejected->why);
    } else {
        progress.discard(wire.index);
    }
}

Result<void> Collector::notAborted() const {
    const auto& aborted = assembler_.aborted();
    if (!aborted) return {};
    return Error{ErrorKind::Device,
                 "the rig aborted frame number " + std::to_string(aborted->frameNumber) + ": " +
                     statusName(aborted->reason),
                 aborted->reason};
}

Result<void> Collector::repair(const ArmedCapture& armed, CaptureProgress& progress) {
    const bool late = link_.clock().now() >= deadline_;
    if (late) deadline_ = link_.clock().now() + patience(armed.plan.exposure);
    for (const MissingChunks& chunks : late ? overdue(armed.expected.frames) : assembler_.lost()) {
        if (!progress.waitsFor(chunks.frame)) continue;
        if (auto asked = askAgain(chunks, armed.expected.captureId, progress); !asked) return asked;
    }
    return {};
}

Result<Collector::Held> Collector::askForAll(const ArmedCapture& armed, CaptureProgress& progress) {
    takeFinished(armed.plan, progress);
    Held all;
    for (const MissingChunks& chunks : overdue(armed.expected.frames)) {
        if (!progress.waitsFor(chunks.frame)) continue;
        const auto sent = resend(chunks, armed.expected.captureId);
        if (!sent && !isGone(sent.error()) && !isFull(sent.error())) return sent.error();
        if (sent) assembler_.askedFor(chunks);
        if (!sent) progress.redo(chunks.frame);
        ++(sent ? all.held : all.gone);
    }
    return all;
}

std::vector<MissingChunks> Collector::overdue(int frames) const {
    std::vector<MissingChunks> all;
    for (int i = 0; i < frames; ++i) {
        if (const auto chunks = assembler_.missing(i)) all.push_back(*chunks);
    }
    return all;
}

Result<void> Collector::askAgain(const MissingChunks& chunks,
                                 std::uint64_t captureId,
                                 CaptureProgress& progress) {
    const std::string range =
        "chunks " + std::to_string(chunks.first) + ".." + std::to_string(chunks.last) + " missing";
    if (!canResend()) {
        progress.giveUp(chunks.frame, range + ", the rig cannot resend");
        return {};
    }
    if (!progress.mayAskAgain(chunks.frame, kResends)) {
        progress.giveUp(chunks.frame, range + " after " + std::to_string(kResends) + " RESENDs");
        return {};
    }
    const auto sent = resend(chunks, captureId);
    if (sent) {
        assembler_.askedFor(chunks);
        return {};
    }
    if (isFull(sent.error())) {
        assembler_.askedFor(chunks);  // once it is late again: what waits is read before
        return {};
    }
    if (!isGone(sent.error())) return sent.error();
    progress.giveUp(
        chunks.frame,
        range + ", " + statusName(static_cast<std::uint16_t>(sent.error().deviceStatus)));
    return {};
}

Result<void> Collector::resend(const MissingChunks& chunks, std::uint64_t captureId) {
    if (!canResend()) return Error{ErrorKind::Device, "the rig cannot resend", status::kFrameGone};
    constexpr Nanoseconds kAtOnce{0};  // nothing is read while a rig is asked again
    const auto sent = link_.command(Op::Resend,
                                    encode(Resend{.captureId = captureId,
                                                  .frame = static_cast<std::uint16_t>(chunks.frame),
                                                  .firstChunk = chunks.first,
                                                  .lastChunk = chunks.last}),
                                    kAtOnce);
    if (!sent) return sent.error();
    return {};
}

bool Collector::canResend() const { return (link_.ident().capabilities & kCanResend) != 0; }

/// PROTOCOL.md 2: a frame is overdue after settling, exposure, two frame periods and 500 ms. Every
/// new chunk starts the wait anew; there are finitely many of them.
Nanoseconds Collector::patience(const Exposure& exposure) const {
    return exposure.granted + 2 * Nanoseconds(Microseconds(link_.limits().framePeriodUs)) +
           Nanoseconds(std::chrono::milliseconds(link_.ident().ledSettleMs)) + 500ms;
}

}  // namespace gonio::driver
