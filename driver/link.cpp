#include "driver/link.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>

namespace gonio::driver {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kAckWait = 100ms;     // PROTOCOL.md 2, "Exactly once"
constexpr int kSends = 3;                   // likewise
constexpr Nanoseconds kPendingLimit = 10s;  // longer than any command of the page can take
constexpr Nanoseconds kBusyLimit = 5s;      // a rig BUSY for longer will not become free
constexpr Nanoseconds kBootLimit = 3s;
constexpr Nanoseconds kStatusWait = 300ms;  // 3 periods of STATUS
constexpr int kFlood = 1024;                // reports in one wait: more is not a rig talking
constexpr std::size_t kEventsKept = 64;     // as many as the rig keeps

std::string rigName(const DeviceStrings& strings) { return "rig " + strings.serial; }

Error deviceError(const std::string& what, int status = 0) {
    return {ErrorKind::Device, what, status};
}

struct Version {
    int major = 0, minor = 0;
    [[nodiscard]] std::string text() const {
        return "GRP/" + std::to_string(major) + "." + std::to_string(minor);
    }
};

/// "GRP/1.0", whole.
std::optional<Version> parseVersion(const std::string& text) {
    constexpr std::string_view kPrefix = "GRP/";
    if (!text.starts_with(kPrefix)) return std::nullopt;
    const char* end = text.data() + text.size();
    Version version;
    const auto major = std::from_chars(text.data() + kPrefix.size(), end, version.major);
    if (major.ec != std::errc{} || major.ptr == end || *major.ptr != '.') return std::nullopt;
    const auto minor = std::from_chars(major.ptr + 1, end, version.minor);
    if (minor.ec != std::errc{} || minor.ptr != end) return std::nullopt;
    return version;
}

Result<void> checkVersion(const std::string& rig, const Version& theirs) {
    if (theirs.major == kProtocolMajor) return {};
    const Version ours{.major = kProtocolMajor, .minor = kProtocolMinor};
    return deviceError(rig + " speaks " + theirs.text() + ", this program " + ours.text() +
                       ": it can be identified, not run; update the older of the two");
}

bool printableSerial(const std::string& serial) {
    return !serial.empty() && serial.size() <= 32 &&
           std::all_of(serial.begin(), serial.end(), [](char c) { return c > ' ' && c <= '~'; });
}

/// The first field of IDENT or LIMITS that no rig can mean; sizes and waits are computed from them.
std::optional<std::string> implausible(const Ident& ident, const Limits& limits) {
    constexpr std::uint32_t kMaxPayload = 16U << 20;    // usbfs allows no larger transfers
    constexpr std::uint32_t kMaxPeriodUs = 60'000'000;  // keeps every deadline finite
    const auto field = [](const char* name, std::uint64_t value) {
        return std::string(name) + " " + std::to_string(value);
    };
    if (ident.ledCount < 1 || ident.ledCount > kMaxLeds) return field("led_count", ident.ledCount);
    if (ident.sensorWidth == 0) return field("sensor_width", ident.sensorWidth);
    if (ident.sensorHeight == 0) return field("sensor_height", ident.sensorHeight);
    if (ident.bitDepth < 1 || ident.bitDepth > 16) return field("bit_depth", ident.bitDepth);
    if (ident.maxChunkPayload == 0 || ident.maxChunkPayload > kMaxPayload)
        return field("max_chunk_payload", ident.maxChunkPayload);
    if (ident.exposureMinUs > ident.exposureMaxUs)
        return field("exposure_min_us", ident.exposureMinUs);
    if (ident.controlLatency == 0) return field("control_latency", ident.controlLatency);
    if (limits.maxFrames == 0) return field("max_frames", limits.maxFrames);
    if (limits.roiStep == 0) return field("roi_step", limits.roiStep);
    if (limits.framePeriodUs == 0 || limits.framePeriodUs > kMaxPeriodUs)
        return field("frame_period_us", limits.framePeriodUs);
    if (limits.fullScale <= limits.blackLevel) return field("full_scale", limits.fullScale);
    return std::nullopt;
}

template <class T>
Result<T> readFeature(Transport& transport, ReportId id, Result<T> (*decode)(const Report&)) {
    const Result<Report> report = transport.getFeature(static_cast<std::uint8_t>(id));
    if (!report) return report.error();
    return decode(*report);
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
    const std::string what = "open " + rigName(link->strings_);
    if (auto done = link->identify(); !done) return done.error().in(what);
    if (auto done = link->claim(); !done) return done.error().in(what);
    return link;
}

RigLink::RigLink(Transport& transport, const LinkOptions& options)
    : transport_(&transport), options_(options), strings_(transport.strings()) {}

RigLink::~RigLink() { (void)release(); }

Result<void> RigLink::identify() {
    if (!printableSerial(strings_.serial)) {
        return deviceError("serial number is not 1..32 printable characters");
    }
    const auto version = parseVersion(strings_.protocol);
    if (!version) {
        return deviceError("string 240 is \"" + strings_.protocol + "\", wanted \"GRP/" +
                           std::to_string(kProtocolMajor) + ".x\": not a gonio rig");
    }
    if (auto same = checkVersion(rigName(strings_), *version); !same) return same;
    const auto ident = readFeature(*transport_, ReportId::Ident, decodeIdent);
    if (!ident) return ident.error();
    const Version theirs{.major = ident->major, .minor = ident->minor};
    if (auto same = checkVersion(rigName(strings_), theirs); !same) return same;
    const auto limits = readFeature(*transport_, ReportId::Limits, decodeLimits);
    if (!limits) return limits.error();
    if (const auto field = implausible(*ident, *limits)) {
        return deviceError("IDENT or LIMITS cannot be: " + *field);
    }
    const auto events = readFeature(*transport_, ReportId::Events, decodeEventsPage);
    if (!events) return events.error();
    ident_ = *ident;
    limits_ = *limits;
    lastEvent_ = events->newest;
    return {};
}

Result<SessionState> RigLink::setSession(bool release) {
    const SessionSet set{.sessionId = options_.sessionId,
                         .heartbeatMs = options_.heartbeatMs,
                         .hostMinor = kProtocolMinor,
                         .release = release};
    if (auto sent = transport_->setFeature(encode(set)); !sent) return sent.error();
    return readFeature(*transport_, ReportId::Session, decodeSessionState);
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
    if (!state) return state.error().in("release " + rigName(strings_));
    if (state->owner == Owner::Alive && state->sessionId == options_.sessionId) {
        return deviceError("release " + rigName(strings_) + ": " +
                               statusName(state->statusOfLastSet) + ", it is still claimed",
                           state->statusOfLastSet);
    }
    return {};
}

Result<Arguments> RigLink::command(Op op, const Arguments& arguments) {
    // Put together only where it is said: a PING amid frames allocates nothing.
    const auto what = [&] { return opName(op) + " to " + rigName(strings_); };
    if (!claimed_) return Error{ErrorKind::Usage, what() + ": the rig has been released"};
    lastCommand_ =
        lastCommand_ == 0xFFFF ? std::uint16_t{1} : static_cast<std::uint16_t>(lastCommand_ + 1);
    const Command command{.sessionLow = static_cast<std::uint32_t>(options_.sessionId),
                          .sequence = lastCommand_,
                          .op = op,
                          .arguments = arguments};
    const Nanoseconds giveUp = clock().now() + kBusyLimit;
    for (int sends = 0; sends < kSends;) {
        const Result<std::optional<Ack>> ack = sendOnce(command);
        if (!ack) return ack.error().in(what());
        if (!*ack) {
            if (++sends < kSends) ++counters_.repeats;
            continue;
        }
        const Ack& answer = **ack;
        if (answer.status == status::kOk) return answer.result;
        if (answer.status == status::kBusy && clock().now() < giveUp) {
            const auto pause = std::chrono::milliseconds(std::max<int>(answer.retryMs, 1));
            if (auto heard = listen(pause); !heard) return heard.error().in(what());
            continue;
        }
        const bool held = answer.status == status::kBusy || answer.status == status::kNotOwner;
        return Error{held ? ErrorKind::Busy : ErrorKind::Device,
                     what() + ": " + statusName(answer.status),
                     answer.status};
    }
    return deviceError(what() + ": no ACK after " + std::to_string(kSends) +
                       " sends; check its cable and power");
}

/// Writes the report once; its final ACK, or nothing when it does not come.
Result<std::optional<Ack>> RigLink::sendOnce(const Command& command) {
    fed_ = clock().now();
    const Nanoseconds giveUp = fed_ + kPendingLimit;
    if (auto sent = transport_->write(encode(command)); !sent) return sent.error();
    Nanoseconds wait = kAckWait;
    while (true) {
        Result<std::optional<Ack>> ack = awaitAck(command, wait);
        if (ack && !*ack) ack = storedAck(command);
        if (!ack || !*ack || (*ack)->status != status::kPending) return ack;
        if (clock().now() >= giveUp) return std::optional<Ack>{};
        wait = std::max<Nanoseconds>(kAckWait, std::chrono::milliseconds((*ack)->retryMs));
    }
}

Result<std::optional<Ack>> RigLink::awaitAck(const Command& command, Nanoseconds wait) {
    const Nanoseconds deadline = clock().now() + wait;
    for (int reports = 0; reports < kFlood; ++reports) {
        const Nanoseconds left = std::max(Nanoseconds{0}, deadline - clock().now());
        const Result<std::optional<Report>> report = transport_->readInput(left);
        if (!report) return report.error();
        if (!*report) break;
        const Result<std::optional<Ack>> ack = handleInput(**report);
        if (!ack) return ack.error();
        if (*ack && answers(**ack, command)) return *ack;
    }
    return std::optional<Ack>{};
}

Result<std::optional<Ack>> RigLink::storedAck(const Command& command) {
    const auto report = transport_->getFeature(static_cast<std::uint8_t>(ReportId::LastAck));
    if (!report) return report.error();
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
    if (status->bootId != ident_.bootId) {
        return deviceError(rigName(strings_) + " has rebooted: boot id " +
                           std::to_string(status->bootId) + ", was " +
                           std::to_string(ident_.bootId) + "; open it again and redo the bracket");
    }
    status_ = *status;
    return answer;
}

/// Only the next one: what a lost report leaves out is re-read in takeEvents.
void RigLink::keep(const Event& event) {
    if (event.sequence != lastEvent_ + 1) return;
    lastEvent_ = event.sequence;
    events_.push_back(event);
    if (events_.size() > kEventsKept) events_.pop_front();
}

/// Takes input reports for the whole of `wait`; what is queued already even when it is 0.
Result<void> RigLink::listen(Nanoseconds wait) {
    const Nanoseconds deadline = clock().now() + wait;
    for (int reports = 0; reports < kFlood; ++reports) {
        const Nanoseconds left = std::max(Nanoseconds{0}, deadline - clock().now());
        const Result<std::optional<Report>> report = transport_->readInput(left);
        if (!report) return report.error();
        if (!*report) return {};
        if (auto ack = handleInput(**report); !ack) return ack.error();
    }
    return {};
}

// The rig wants a PING at least every heartbeat / 4; a fifth leaves room for the ACK of another.
Nanoseconds RigLink::untilPing() const {
    const Nanoseconds period = Nanoseconds(std::chrono::milliseconds(options_.heartbeatMs)) / 5;
    return std::max(Nanoseconds{0}, fed_ + period - clock().now());
}

Result<void> RigLink::keepAlive() {
    if (auto heard = listen(Nanoseconds{0}); !heard) return heard.error();
    if (untilPing() > Nanoseconds{0}) return {};
    if (auto pong = command(Op::Ping); !pong) return pong.error();
    return {};
}

Result<std::optional<BulkBytes>> RigLink::readBulk(Nanoseconds wait) {
    const Nanoseconds deadline = clock().now() + wait;
    while (true) {
        if (auto alive = keepAlive(); !alive) return alive.error();
        const Nanoseconds left = std::max(Nanoseconds{0}, deadline - clock().now());
        auto transfer = transport_->readBulk(std::min(left, untilPing()));
        if (!transfer || *transfer || clock().now() >= deadline) return transfer;
    }
}

Result<Status> RigLink::freshStatus() {
    if (auto heard = listen(Nanoseconds{0}); !heard) return heard.error();
    status_.reset();
    const Nanoseconds deadline = clock().now() + kStatusWait;
    while (!status_ && clock().now() < deadline) {
        const Result<std::optional<Report>> report =
            transport_->readInput(deadline - clock().now());
        if (!report) return report.error();
        if (!*report) break;
        if (auto ack = handleInput(**report); !ack) return ack.error();
    }
    if (!status_) {
        return deviceError("no STATUS from " + rigName(strings_) +
                           " in 300 ms; check its cable and power");
    }
    return *status_;
}

Result<Stats> RigLink::stats() { return readFeature(*transport_, ReportId::Stats, decodeStats); }

Result<std::vector<Event>> RigLink::takeEvents() {
    if (auto heard = listen(Nanoseconds{0}); !heard) return heard.error();
    for (std::size_t pages = 0; pages < kEventsKept; ++pages) {
        if (auto set = transport_->setFeature(encodeEventsFrom(lastEvent_ + 1)); !set)
            return set.error();
        const auto page = readFeature(*transport_, ReportId::Events, decodeEventsPage);
        if (!page) return page.error();
        const std::uint32_t before = lastEvent_;
        for (const Event& event : page->events) {
            if (event.sequence <= lastEvent_) continue;
            lastEvent_ = event.sequence - 1;
            keep(event);
        }
        if (lastEvent_ == before || page->newest <= lastEvent_) break;
    }
    std::vector<Event> taken(events_.begin(), events_.end());
    events_.clear();
    return taken;
}

}  // namespace gonio::driver
