#include "driver/link.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "proc/core/number_text.h"

namespace gonio::driver {
namespace {

using std::chrono::milliseconds;

constexpr Nanoseconds kAckWait = milliseconds(100);
constexpr int kSends = 3;
constexpr Nanoseconds kCommandDeadline = std::chrono::seconds(10);
constexpr std::size_t kKeptEvents = 256;

Error linkError(const std::string& what, std::uint16_t status = 0) {
    return {ErrorKind::Device, "rig: " + what, status};
}

/// "GRP/1.0" -> 1; empty when it is something else.
std::optional<std::int64_t> majorOf(const std::string& protocol) {
    if (!protocol.starts_with("GRP/")) return std::nullopt;
    return parseInteger(std::string_view(protocol).substr(4, protocol.find('.') - 4));
}

}  // namespace

Result<RigLink> RigLink::open(Transport& transport, std::uint64_t sessionId) {
    const DeviceStrings strings = transport.strings();
    const std::string name = "rig " + strings.serial;
    if (majorOf(strings.protocol) != kProtocolMajor) {
        return Error{ErrorKind::Device,
                     name + " speaks '" + strings.protocol + "', this program GRP/" +
                         std::to_string(kProtocolMajor) + "." + std::to_string(kProtocolMinor) +
                         ": it can be identified but not run"};
    }
    RigLink link(transport, sessionId);
    const Result<Report> identBytes =
        transport.getFeature(static_cast<std::uint8_t>(ReportId::Ident));
    if (!identBytes) return identBytes.error().in(name);
    const Result<Ident> ident = decodeIdent(*identBytes);
    if (!ident) return ident.error().in(name);
    link.ident_ = *ident;
    if (ident->major != kProtocolMajor) {
        return linkError("IDENT says protocol major " + std::to_string(ident->major) + ", wanted " +
                         std::to_string(kProtocolMajor));
    }
    if (ident->ledCount < 1 || ident->ledCount > kMaxLeds || ident->maxChunkPayload == 0 ||
        ident->sensorWidth == 0 || ident->sensorHeight == 0) {
        return linkError("IDENT holds impossible values (LEDs, chunk size or sensor size)");
    }
    const Result<Report> limitBytes =
        transport.getFeature(static_cast<std::uint8_t>(ReportId::Limits));
    if (!limitBytes) return limitBytes.error().in(name);
    const Result<Limits> limits = decodeLimits(*limitBytes);
    if (!limits) return limits.error().in(name);
    link.limits_ = *limits;
    if (Result<void> claimed = link.claim(); !claimed) return claimed.error().in(name);
    return link;
}

Result<void> RigLink::claim() {
    const SessionSet set{.sessionId = sessionId_, .heartbeatMs = heartbeatMs_};
    if (Result<void> sent = transport_->setFeature(encode(set)); !sent) return sent;
    const Result<Report> bytes =
        transport_->getFeature(static_cast<std::uint8_t>(ReportId::Session));
    if (!bytes) return bytes.error();
    const Result<SessionState> state = decodeSessionState(*bytes);
    if (!state) return state.error();
    if (state->sessionId != sessionId_ || state->owner != Owner::Alive) {
        return Error{ErrorKind::Busy,
                     "held by another program (" + statusName(state->statusOfLastSet) +
                         "): close it and try again",
                     state->statusOfLastSet};
    }
    sequence_ = state->lastCommand;
    lastSent_ = transport_->clock().now();
    return {};
}

bool RigLink::answers(const Ack& ack, const Command& command) const {
    return ack.sessionLow == static_cast<std::uint32_t>(sessionId_) &&
           ack.sequence == command.sequence && ack.op == command.op;
}

std::optional<Ack> RigLink::sort(const Report& report, const Command* waitingFor) {
    switch (static_cast<ReportId>(report[0])) {
        case ReportId::Status:
            if (const auto status = decodeStatus(report)) status_ = *status;
            break;
        case ReportId::Event:
            if (const auto event = decodeEvent(report)) {
                events_.push_back(*event);
                if (events_.size() > kKeptEvents) events_.pop_front();
            }
            break;
        case ReportId::Ack:
            if (const auto ack = decodeAck(report);
                ack && waitingFor && answers(*ack, *waitingFor)) {
                return *ack;
            }
            break;
        default: break;  // a newer minor's report: skipped
    }
    return std::nullopt;
}

Result<std::optional<Ack>> RigLink::awaitAck(const Command& command, Nanoseconds wait) {
    const Nanoseconds deadline = transport_->clock().now() + wait;
    while (true) {
        const Nanoseconds left = deadline - transport_->clock().now();
        const auto report = transport_->readInput(std::max(left, Nanoseconds(0)));
        if (!report) return report.error();
        if (*report) {
            if (const auto ack = sort(**report, &command)) return std::optional(*ack);
        } else if (left <= Nanoseconds(0)) {
            return std::optional<Ack>();
        }
    }
}

Result<std::optional<Ack>> RigLink::readLastAck(const Command& command) {
    const Result<Report> bytes =
        transport_->getFeature(static_cast<std::uint8_t>(ReportId::LastAck));
    if (!bytes) return bytes.error();
    const Result<Ack> ack = decodeAck(*bytes, ReportId::LastAck);
    if (!ack || !answers(*ack, command)) return std::optional<Ack>();
    return std::optional(*ack);
}

Result<Arguments> RigLink::command(Op op, const Arguments& arguments) {
    sequence_ = static_cast<std::uint16_t>(sequence_ == 65535 ? 1 : sequence_ + 1);
    const Command command{.sessionLow = static_cast<std::uint32_t>(sessionId_),
                          .sequence = sequence_,
                          .op = op,
                          .arguments = arguments};
    const std::string name = "command " + std::to_string(static_cast<int>(op));
    const Nanoseconds deadline = transport_->clock().now() + kCommandDeadline;
    for (int sends = 0; sends < kSends && transport_->clock().now() < deadline; ++sends) {
        if (Result<void> sent = transport_->write(encode(command)); !sent) return sent.error();
        lastSent_ = transport_->clock().now();
        Nanoseconds wait = kAckWait;
        while (transport_->clock().now() < deadline) {
            Result<std::optional<Ack>> ack = awaitAck(command, wait);
            if (ack && !*ack) ack = readLastAck(command);
            if (!ack) return ack.error().in(name);
            if (!*ack) break;  // silence: send again
            const Ack& answer = **ack;
            if (answer.status == status::kOk) return answer.result;
            const Nanoseconds retry = milliseconds(answer.retryMs);
            if (answer.status == status::kPending) {
                wait = retry + kAckWait;
                continue;
            }
            if (answer.status == status::kBusy) {
                // Nothing was done: the same report again, later. That is no lost send.
                const Result<std::optional<Ack>> pause = awaitAck(command, retry);
                if (!pause) return pause.error();
                --sends;
                break;
            }
            return linkError(name + ": " + statusName(answer.status), answer.status);
        }
    }
    return linkError(name + ": no answer after " + std::to_string(kSends) +
                     " sends; check the cable, then reconnect the rig");
}

Result<void> RigLink::keepAlive() {
    while (true) {
        const auto report = transport_->readInput(Nanoseconds(0));
        if (!report) return report.error();
        if (!*report) break;
        (void)sort(**report, nullptr);
    }
    if (transport_->clock().now() - lastSent_ < milliseconds(heartbeatMs_) / 4) return {};
    const Result<Arguments> pong = command(Op::Ping);
    if (!pong) return pong.error();
    return {};
}

std::deque<Event> RigLink::takeEvents() { return std::exchange(events_, {}); }

Result<void> RigLink::release() {
    return transport_->setFeature(
        encode(SessionSet{.sessionId = sessionId_, .heartbeatMs = heartbeatMs_, .release = true}));
}

}  // namespace gonio::driver
