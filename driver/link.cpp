#include "driver/link.h"

#include <algorithm>
#include <string>
#include <utility>

namespace gonio::driver {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kAckWait = 100ms;     // PROTOCOL.md 2, "Exactly once"
constexpr int kSends = 3;                   // likewise
constexpr Nanoseconds kPendingLimit = 10s;  // longer than any command of the page can take
constexpr Nanoseconds kBootLimit = 3s;
// Reports that are silent are opened anew or lost by then (watched_transport.h): within 900 ms.
constexpr Nanoseconds kStatusWait = 1200ms;
constexpr int kFlood = 1024;               // reports in one wait: more is not a rig talking
constexpr std::size_t kEventsKept = 64;    // as many as the rig keeps
constexpr std::size_t kEventsHeld = 1024;  // for a caller who does not take them

Error deviceError(const std::string& what, int status = 0) {
    return {ErrorKind::Device, what, status};
}

}  // namespace

Result<std::unique_ptr<RigLink>> RigLink::open(Transport& transport, const LinkOptions& options) {
    if ((options.sessionId & 0xFFFFFFFFU) == 0) {
        return Error{ErrorKind::Usage, "session id: its low half is 0, wanted a random number"};
    }
    if (options.heartbeatMs < 500 || options.heartbeatMs > 10000) {
        return Error{
            ErrorKind::Usage,
            "heartbeat: " + std::to_string(options.heartbeatMs) + " ms, wanted 500..10000"};
    }
    std::unique_ptr<RigLink> link(new RigLink(transport, options));
    const std::string what = "open " + rigName(link->strings());
    if (auto done = link->identify(); !done) return done.error().in(what);
    const auto events = readFeature(link->wire_, ReportId::Events, decodeEventsPage);
    if (!events) return events.error().in(what);
    link->lastEvent_ = events->newest;
    if (auto done = link->claim(); !done) return done.error().in(what);
    return link;
}

RigLink::RigLink(Transport& transport, const LinkOptions& options)
    : wire_(transport),
      options_(options),
      identity_{.strings = transport.strings(), .ident = {}, .limits = {}} {
    events_.reserve(kEventsHeld + 1);
}

RigLink::~RigLink() { (void)release(); }

Result<void> RigLink::identify() {
    auto identity = readIdentity(wire_);
    if (!identity) return identity.error();
    identity_ = std::move(*identity);
    return {};
}

Result<void> RigLink::resume(Transport& transport) {
    const std::string what = "come back to " + rigName(strings());
    abandon({ErrorKind::Device, what});
    cutOffDone_.reset();
    wire_.attach(transport);
    if (auto done = takeUp(transport.strings()); !done) {
        const Error why = done.error().in(what);
        abandon(why);
        return why;
    }
    return {};
}

Result<void> RigLink::takeUp(const DeviceStrings& there) {
    if (there.serial != strings().serial) {
        return deviceError("wanted " + rigName(strings()) + ", refused " + rigName(there) +
                           ": plug the first in again");
    }
    // What still waits is from before; it is read again as far as it matters.
    if (auto stale = dropInputs(); !stale) return stale;
    const std::uint32_t boot = ident().bootId;
    if (auto done = identify(); !done) return done;
    const bool otherBoot = ident().bootId != boot;
    if (otherBoot) lastEvent_ = 0;
    soughtEvent_ = 0;
    status_.reset();
    statusSequence_.reset();
    if (auto done = claim(); !done) return done;
    if (auto done = recall(otherBoot); !done) return done;
    return readEvents();
}

/// LAST_ACK tells of the command that was cut off, where it is whole and of this claim.
Result<void> RigLink::recall(bool otherBoot) {
    const std::optional<Command> cutOff = std::exchange(unanswered_, std::nullopt);
    if (!cutOff) return {};
    if (otherBoot) {
        cutOffDone_ = false;
        return {};
    }
    const auto report = wire_.getFeature(static_cast<std::uint8_t>(ReportId::LastAck));
    if (!report && lost()) {
        unanswered_ = cutOff;  // lost again, before it could be asked
        return report.error();
    }
    if (!report) return {};
    const Result<Ack> ack = decodeAck(*report, ReportId::LastAck);
    if (!ack || ack->sessionLow != cutOff->sessionLow) return {};
    const bool its = ack->sequence == cutOff->sequence && ack->op == cutOff->op;
    if (!its || ack->status != status::kPending) cutOffDone_ = its && ack->status == status::kOk;
    return {};
}

Result<void> RigLink::dropInputs() {
    for (int reports = 0; reports < kFlood; ++reports) {
        const auto report = wire_.readInput(Nanoseconds{0});
        if (!report) return report.error();
        if (!*report) break;
    }
    return {};
}

Result<SessionState> RigLink::setSession(bool release) {
    const SessionSet set{.sessionId = options_.sessionId,
                         .heartbeatMs = options_.heartbeatMs,
                         .hostMinor = kProtocolMinor,
                         .release = release};
    if (auto sent = wire_.setFeature(encode(set)); !sent) return sent.error();
    return readFeature(wire_, ReportId::Session, decodeSessionState);
}

Result<void> RigLink::claim() {
    const Nanoseconds giveUp = clock().now() + kBootLimit;
    while (true) {
        const Result<SessionState> state = setSession(false);
        if (!state) return state.error().in("claim");
        const bool alive = state->owner == Owner::Alive;
        if (alive && state->sessionId == options_.sessionId) {
            claimed_ = true;
            resumed_ = state->lastCommand != 0;
            lastCommand_ = state->lastCommand;
            fed_ = clock().now();
            wire_.watch(ident().bootId);
            return {};
        }
        if (alive) {
            return Error{ErrorKind::Busy,
                         "claim: held by another program's session; close it, or wait until its "
                         "heartbeat lapses",
                         status::kBusy};
        }
        const bool booting = state->statusOfLastSet == status::kBusy;
        if (!booting || clock().now() >= giveUp) {
            return deviceError("claim refused: " + statusName(state->statusOfLastSet),
                               state->statusOfLastSet);
        }
        if (auto heard = listen(kAckWait); !heard) return heard.error().in("claim");
    }
}

Result<void> RigLink::release() {
    if (!std::exchange(claimed_, false)) return {};
    const Result<SessionState> state = setSession(true);
    if (!state) return state.error().in("release " + rigName(strings()));
    if (state->owner == Owner::Alive && state->sessionId == options_.sessionId) {
        return deviceError("release " + rigName(strings()) + ": " +
                               statusName(state->statusOfLastSet) + ", it is still claimed",
                           state->statusOfLastSet);
    }
    return {};
}

Result<Arguments> RigLink::command(Op op, const Arguments& arguments, Nanoseconds patience) {
    // Put together only where it is said: a PING amid frames allocates nothing.
    const auto what = [&] { return opName(op) + " to " + rigName(strings()); };
    if (!claimed_) return Error{ErrorKind::Usage, what() + ": the rig has been released"};
    lastCommand_ =
        lastCommand_ == 0xFFFF ? std::uint16_t{1} : static_cast<std::uint16_t>(lastCommand_ + 1);
    const Command command{.sessionLow = static_cast<std::uint32_t>(options_.sessionId),
                          .sequence = lastCommand_,
                          .op = op,
                          .arguments = arguments};
    unanswered_ = command;
    const Nanoseconds giveUp = clock().now() + patience;
    for (int sends = 0; sends < kSends;) {
        const Result<std::optional<Ack>> ack = sendOnce(command);
        if (!ack) return ack.error().in(what());
        if (!*ack) {
            if (++sends < kSends) ++counters_.repeats;
            continue;
        }
        const Ack& answer = **ack;
        unanswered_.reset();
        if (answer.status == status::kOk) return answer.result;
        if (answer.status == status::kBusy && clock().now() < giveUp) {
            // Sent again in time for the heartbeat, whatever pause the rig asks for.
            const Nanoseconds pause = std::min<Nanoseconds>(
                std::chrono::milliseconds(std::max<int>(answer.retryMs, 1)), pingPeriod());
            if (auto heard = listen(pause); !heard) return heard.error().in(what());
            unanswered_ = command;
            continue;
        }
        const bool held = answer.status == status::kBusy || answer.status == status::kNotOwner;
        const Error refused{held ? ErrorKind::Busy : ErrorKind::Device,
                            what() + ": " + statusName(answer.status),
                            answer.status};
        if (answer.status == status::kNotOwner) abandon(refused);
        return refused;
    }
    const std::string silent = what() + ": no ACK after " + std::to_string(kSends) + " sends; ";
    if (const auto why = wire_.suspect(deviceError(silent + "check its cable and power")))
        return *why;
    return wire_.lose(deviceError(silent + "it answers, but takes no commands"),
                      WatchedTransport::Port::Reset);
}

/// Writes the report once; its final ACK, or nothing when it does not come.
Result<std::optional<Ack>> RigLink::sendOnce(const Command& command) {
    fed_ = clock().now();
    const Nanoseconds giveUp = fed_ + kPendingLimit;
    // A rig that is there and did not take it is sent it again.
    if (auto sent = wire_.write(encode(command)); !sent && lost()) return sent.error();
    Nanoseconds wait = kAckWait;
    while (true) {
        Result<std::optional<Ack>> ack = awaitAck(command, wait);
        if (ack && !*ack) ack = storedAck(command);
        if (!ack || !*ack || (*ack)->status != status::kPending) return ack;
        if (clock().now() >= giveUp) return std::optional<Ack>{};
        wait = std::max<Nanoseconds>(kAckWait, std::chrono::milliseconds((*ack)->retryMs));
        wait = std::min(wait, giveUp - clock().now());
    }
}

Result<std::optional<Ack>> RigLink::awaitAck(const Command& command, Nanoseconds wait) {
    const Nanoseconds deadline = clock().now() + wait;
    for (int reports = 0; reports < kFlood; ++reports) {
        const Nanoseconds left = std::max(Nanoseconds{0}, deadline - clock().now());
        const Result<std::optional<Report>> report = wire_.readInput(left);
        if (!report) return report.error();
        if (!*report) break;
        const Result<std::optional<Ack>> ack = handleInput(**report);
        if (!ack) return ack.error();
        if (*ack && answers(**ack, command)) return *ack;
    }
    return std::optional<Ack>{};
}

Result<std::optional<Ack>> RigLink::storedAck(const Command& command) {
    const auto report = wire_.getFeature(static_cast<std::uint8_t>(ReportId::LastAck));
    if (!report && lost()) return report.error();
    if (!report) return std::optional<Ack>{};
    // "All zero when none" has no CRC either; a damaged one is merely no answer.
    const Result<Ack> ack = decodeAck(*report, ReportId::LastAck);
    if (!ack || ack->sequence != command.sequence || ack->op != command.op ||
        ack->sessionLow != command.sessionLow) {
        return std::optional<Ack>{};
    }
    return std::optional<Ack>{*ack};
}

bool RigLink::answers(const Ack& ack, const Command& command) {
    if (ack.sessionLow != command.sessionLow) {
        ++counters_.foreignAcks;
        return false;
    }
    if (ack.sequence == command.sequence && ack.op == command.op) return true;
    ++counters_.strayAcks;
    return false;
}

Result<std::optional<Ack>> RigLink::handleInput(const Report& report) {
    std::optional<Ack> answer;
    if (!crcAgrees(report)) {
        ++counters_.badReports;
        return answer;
    }
    switch (static_cast<ReportId>(report[0])) {
        case ReportId::Ack:
            if (const auto ack = decodeAck(report)) answer = *ack;
            return answer;
        case ReportId::Event:
            if (const auto event = decodeEvent(report)) keep(*event);
            return answer;
        case ReportId::Status: break;
        default: ++counters_.unknownReports; return answer;
    }
    const Result<Status> status = decodeStatus(report);
    if (!status) return answer;
    if (status->bootId != ident().bootId) return wire_.loseToReboot(status->bootId);
    follow(*status);
    return answer;
}

/// Its numbers wrap; one from before is no gap.
void RigLink::follow(const Status& status) {
    if (statusSequence_) {
        const auto jump = static_cast<std::uint16_t>(status.sequence - *statusSequence_ - 1);
        if (jump < 0x8000) counters_.lostStatuses += jump;
    }
    statusSequence_ = status.sequence;
    status_ = status;
    if (std::exchange(eventsUnread_, false)) soughtEvent_ = 0;
}

/// Only the next one: what a lost report leaves out is re-read in takeEvents.
void RigLink::keep(const Event& event) {
    if (event.sequence != lastEvent_ + 1) return;
    lastEvent_ = event.sequence;
    events_.push_back(event);
    if (events_.size() <= kEventsHeld) return;
    events_.erase(events_.begin());
    ++counters_.missedEvents;
}

/// Takes input reports for the whole of `wait`; what is queued already even when it is 0.
Result<void> RigLink::listen(Nanoseconds wait) {
    const Nanoseconds deadline = clock().now() + wait;
    for (int reports = 0; reports < kFlood; ++reports) {
        const Nanoseconds left = std::max(Nanoseconds{0}, deadline - clock().now());
        const Result<std::optional<Report>> report = wire_.readInput(left);
        if (!report) return report.error();
        if (!*report) return {};
        if (auto ack = handleInput(**report); !ack) return ack.error();
    }
    return {};
}

// The rig wants a PING at least every heartbeat / 4; a fifth leaves room for the ACK of another.
Nanoseconds RigLink::pingPeriod() const {
    return Nanoseconds(std::chrono::milliseconds(options_.heartbeatMs)) / 5;
}

Nanoseconds RigLink::untilPing() const {
    return std::max(Nanoseconds{0}, fed_ + pingPeriod() - clock().now());
}

Result<void> RigLink::keepAlive() {
    if (auto heard = listen(Nanoseconds{0}); !heard) return heard;
    if (missesEvents()) {
        if (auto read = readEvents(); !read) return read;
    }
    if (untilPing() > Nanoseconds{0}) return {};
    if (auto pong = command(Op::Ping); !pong) return pong.error();
    return {};
}

Result<std::optional<BulkBytes>> RigLink::readBulk(Nanoseconds wait) {
    const Nanoseconds deadline = clock().now() + wait;
    while (true) {
        if (auto alive = keepAlive(); !alive) return alive.error();
        const Nanoseconds left = std::max(Nanoseconds{0}, deadline - clock().now());
        auto transfer = wire_.readBulk(std::min(left, untilPing()));
        if (!transfer || *transfer || clock().now() >= deadline) return transfer;
    }
}

Result<Status> RigLink::freshStatus() {
    if (auto heard = listen(Nanoseconds{0}); !heard) return heard.error();
    status_.reset();
    const Nanoseconds deadline = clock().now() + kStatusWait;
    while (!status_ && clock().now() < deadline) {
        const Result<std::optional<Report>> report = wire_.readInput(deadline - clock().now());
        if (!report) return report.error();
        if (!*report) break;
        if (auto ack = handleInput(**report); !ack) return ack.error();
    }
    if (!status_) {
        return deviceError("no STATUS from " + rigName(strings()) +
                           " in 1.2 s, though it sends other reports; update its firmware");
    }
    return *status_;
}

Result<Stats> RigLink::stats() { return readFeature(wire_, ReportId::Stats, decodeStats); }

/// Their reports were lost, and a STATUS came that says so. What was sought once is not sought
/// again until there is more: a rig that promises what it does not have costs one look.
bool RigLink::missesEvents() const {
    return status_ && status_->newestEvent > lastEvent_ && status_->newestEvent != soughtEvent_;
}

Result<EventsPage> RigLink::readEventsPage() {
    if (auto set = wire_.setFeature(encodeEventsFrom(lastEvent_ + 1)); !set) return set.error();
    return readFeature(wire_, ReportId::Events, decodeEventsPage);
}

/// A page that is damaged or refused is no loss: the next STATUS asks for it again.
Result<void> RigLink::readEvents() {
    if (status_) soughtEvent_ = status_->newestEvent;
    for (std::size_t pages = 0; pages < kEventsKept; ++pages) {
        const auto page = readEventsPage();
        if (!page) {
            if (lost()) return page.error();
            ++counters_.badReports;
            eventsUnread_ = true;
            return {};
        }
        const std::uint32_t before = lastEvent_;
        for (const Event& event : page->events) {
            if (event.sequence <= lastEvent_) continue;
            counters_.missedEvents += event.sequence - lastEvent_ - 1;
            lastEvent_ = event.sequence - 1;
            keep(event);
        }
        if (lastEvent_ == before || page->newest <= lastEvent_) break;
    }
    return {};
}

Result<std::vector<Event>> RigLink::takeEvents() {
    if (auto heard = listen(Nanoseconds{0}); !heard) return heard.error();
    if (auto read = readEvents(); !read) return read.error();
    std::vector<Event> taken(events_.begin(), events_.end());
    events_.clear();
    return taken;
}

}  // namespace gonio::driver
