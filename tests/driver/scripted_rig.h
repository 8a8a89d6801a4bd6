#pragma once
// A rig for driver tests: honest and instant unless a script says otherwise. It shares the codec
// with the driver and nothing else; its clock moves only while somebody waits.

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "driver/protocol/reports.h"
#include "driver/protocol/transport.h"
#include "tests/driver/wire_frames.h"

namespace gonio::driver::test {

class ScriptedRig : public Transport, private Clock {
public:
    // What the script may change before or between calls.
    DeviceStrings identity{
        .vendor = 0x1209, .product = 1, .serial = "TEST-0001", .protocol = "GRP/1.0"};
    Ident ident{.major = 1,
                .capabilities = 4,
                .bootId = kBoot,
                .sensorWidth = 64,
                .sensorHeight = 48,
                .bitDepth = 12,
                .ledCount = 4,
                .ledAngle = {0, 2000, 4000, 6000},
                .wavelengthNm = {630, 525, 465},
                .maxChunkPayload = kPayload,
                .frameRam = 8,
                .exposureMinUs = 20,
                .exposureMaxUs = 1000000,
                .controlLatency = 2,
                .ledSettleMs = 5};
    Limits limits{.formats = 3,
                  .binnings = 7,
                  .roiStep = 2,
                  .maxFrames = 16,
                  .framePeriodUs = 40000,
                  .gainMax = 2400,
                  .blackLevel = 60,
                  .fullScale = 4095};
    SessionState session;
    int bootingClaims = 0;    ///< claims answered BUSY, as during boot
    bool deaf = false;        ///< commands vanish
    int loseCommands = 0;     ///< the next ones vanish
    int loseAcks = 0;         ///< the next ACK reports vanish; LAST_ACK has them
    bool noLastAck = false;   ///< LAST_ACK is empty
    Nanoseconds ackDelay{0};  ///< of ACK reports
    std::deque<Ack> before;   ///< status and retry_ms answered before the command is done
    std::map<Op, std::uint16_t> refuse;  ///< final statuses
    std::uint32_t latency = 0;           ///< frames until SET_LED and SET_EXPOSURE take effect
    bool mute = false;                   ///< no STATUS reports
    int reopensToHear = 0;               ///< mute ends when reports were opened anew so often
    int refuseWrites = 0;                ///< the next ones stall
    int refuseEvents = 0;                ///< the next EVENTS pages stall
    int spoilEvents = 0;                 ///< the next EVENTS pages come damaged
    std::uint32_t promisedEvents = 0;    ///< newest_event_seq of STATUS, whatever there is
    RigState state = RigState::Idle;
    std::uint16_t fault = 0;
    std::function<void(FrameToSend&)> onFrame;          ///< each frame as it is exposed
    std::function<void(std::vector<Bytes>&)> onStream;  ///< the chunks of an ARM or RESEND
    std::uint32_t frameBytesOff = 0;                    ///< added to SET_FORMAT's answer

    // What it saw.
    std::vector<Command> log;  ///< every COMMAND report, repeats too
    int done = 0;              ///< commands carried out
    int eventPages = 0;        ///< EVENTS that were read
    SetLed led{};
    Nanoseconds longestSilence{0};  ///< between commands while claimed

    [[nodiscard]] int count(Op op) const {
        return static_cast<int>(std::count_if(
            log.begin(), log.end(), [op](const Command& command) { return command.op == op; }));
    }
    void sendInput(const Report& report, Nanoseconds delay = Nanoseconds{0}) {
        inputs_.emplace(now_ + delay, report);
    }
    void raise(const Event& event, bool asReport) {
        events_.push_back(event);
        constexpr std::size_t kKept = 64;
        if (events_.size() > kKept) events_.pop_front();
        if (asReport) sendInput(encode(event));
    }
    void pass(Nanoseconds time) { now_ += time; }
    /// The cable is pulled: dark, flushed, lapsed; what is on its way is lost. Frames and ACKs
    /// stay.
    void linkLost() {
        led = {};
        state = RigState::Idle;
        stream.clear();
        inputs_.clear();
        if (session.owner == Owner::Alive) session.owner = Owner::Lapsed;
    }
    /// The power too: another boot, which knows nothing.
    void powerLost() {
        linkLost();
        ++ident.bootId;
        session = {};
        lastAck_.reset();
        events_.clear();
        ram_.clear();
        exposure_ = {};
        format_ = {};
        nextFrame_ = effective_ = sequence_ = 1;
    }
    void forgetFrames() { ram_.clear(); }
    std::deque<Bytes> stream;  ///< transfers to come

    // Transport
    [[nodiscard]] DeviceStrings strings() const override { return identity; }
    [[nodiscard]] const Clock& clock() const override { return *this; }

    Result<void> write(const Report& report) override {
        const auto command = decodeCommand(report);
        if (!command) return command.error();
        if (refuseWrites > 0) {
            --refuseWrites;
            return Error{ErrorKind::Device, "stalled"};
        }
        log.push_back(*command);
        if (deaf) return {};
        if (loseCommands > 0) {
            --loseCommands;
            return {};
        }
        longestSilence = std::max(longestSilence, now_ - lastCommandAt_);
        lastCommandAt_ = now_;
        answer(*command);
        return {};
    }

    Result<void> setFeature(const Report& report) override {
        if (report[0] == static_cast<std::uint8_t>(ReportId::Events)) {
            eventsFrom_ = *decodeEventsFrom(report);
            return {};
        }
        const auto set = decodeSessionSet(report);
        if (!set) return set.error();
        if (bootingClaims > 0) {
            --bootingClaims;
            session.statusOfLastSet = status::kBusy;
        } else if (session.owner == Owner::Alive && session.sessionId != set->sessionId) {
            session.statusOfLastSet = status::kBusy;
        } else if (set->release) {
            session = {};
            led = {};
        } else {
            session.sessionId = set->sessionId;
            session.owner = Owner::Alive;
            session.heartbeatMs = set->heartbeatMs;
            session.statusOfLastSet = status::kOk;
            lastCommandAt_ = now_;
        }
        return {};
    }

    [[nodiscard]] Result<Report> getFeature(std::uint8_t id) override {
        switch (static_cast<ReportId>(id)) {
            case ReportId::Ident: return encode(ident);
            case ReportId::Limits: return encode(limits);
            case ReportId::Session: return encode(session);
            case ReportId::Stats: return encode(Stats{.commandsDone = 7});
            case ReportId::Events: return readEvents();
            case ReportId::LastAck:
                if (noLastAck || !lastAck_) return Report{};
                return encode(*lastAck_, ReportId::LastAck);
            default: return Error{ErrorKind::Device, "stalled"};
        }
    }

    [[nodiscard]] Result<std::optional<Report>> readInput(Nanoseconds wait) override {
        const Nanoseconds deadline = now_ + wait;
        const auto next = inputs_.begin();
        const bool statusFirst = !mute && nextStatus_ <= deadline &&
                                 (next == inputs_.end() || nextStatus_ <= next->first);
        if (statusFirst) {
            now_ = std::max(now_, nextStatus_);
            nextStatus_ = now_ + std::chrono::milliseconds(100);
            return std::optional(encode(status()));
        }
        if (next == inputs_.end() || next->first > deadline) {
            now_ = deadline;
            return std::optional<Report>{};
        }
        now_ = std::max(now_, next->first);
        const Report report = next->second;
        inputs_.erase(next);
        return std::optional(report);
    }

    [[nodiscard]] Result<std::optional<BulkBytes>> readBulk(Nanoseconds wait) override {
        if (stream.empty()) {
            now_ += wait;
            return std::optional<BulkBytes>{};
        }
        lent_ = std::move(stream.front());
        stream.pop_front();
        return std::optional<BulkBytes>(lent_);
    }

    Result<void> reopenReports() override {
        inputs_.clear();
        if (reopensToHear > 0 && --reopensToHear == 0) mute = false;
        return {};
    }
    Result<void> resetPort() override {
        stream.clear();
        return {};
    }

private:
    [[nodiscard]] Nanoseconds now() const override { return now_; }

    [[nodiscard]] Status status() {
        return {
            .sequence = statusSequence_++,
            .bootId = ident.bootId,
            .state = state,
            .newestEvent = std::max(promisedEvents, events_.empty() ? 0 : events_.back().sequence),
            .fault = fault,
            .owner = session.owner};
    }

    [[nodiscard]] EventsPage eventsPage() const {
        EventsPage page;
        if (!events_.empty()) {
            page.oldest = events_.front().sequence;
            page.newest = events_.back().sequence;
        }
        for (const Event& event : events_) {
            if (event.sequence >= eventsFrom_ && page.events.size() < 2)
                page.events.push_back(event);
        }
        return page;
    }

    Result<Report> readEvents() {
        ++eventPages;
        if (refuseEvents > 0) {
            --refuseEvents;
            return Error{ErrorKind::Device, "stalled"};
        }
        Report page = encode(eventsPage());
        if (spoilEvents > 0) {
            --spoilEvents;
            page.back() ^= 1;
        }
        return page;
    }

    void answer(const Command& command) {
        Ack ack{.sequence = command.sequence, .op = command.op, .sessionLow = command.sessionLow};
        if (lastAck_ && lastAck_->sequence == command.sequence &&
            lastAck_->status != status::kPending) {
            ack = *lastAck_;  // replayed
        } else if (!before.empty()) {
            ack.status = before.front().status;
            ack.retryMs = before.front().retryMs;
            before.pop_front();
            if (ack.status == status::kPending) {
                sendInput(encode(ack), ackDelay);
                Ack final{.sequence = command.sequence,
                          .op = command.op,
                          .result = execute(command),
                          .sessionLow = command.sessionLow};
                const auto pause = std::chrono::milliseconds(ack.retryMs);
                sendInput(encode(final), ackDelay + pause);
                lastAck_ = ack;
                return;
            }
        } else if (const auto refused = refuse.find(command.op); refused != refuse.end()) {
            ack.status = refused->second;
        } else if (session.owner != Owner::Alive) {
            ack.status = status::kNotOwner;
        } else if (command.op == Op::Resend && !holds(decodeResend(command.arguments))) {
            ack.status = status::kFrameGone;
            session.lastCommand = command.sequence;
        } else {
            ack.result = execute(command);
        }
        if (ack.status != status::kBusy && ack.status != status::kNotOwner) lastAck_ = ack;
        if (loseAcks > 0) {
            --loseAcks;
        } else {
            sendInput(encode(ack), ackDelay);
        }
    }

    Arguments execute(const Command& command) {
        ++done;
        session.lastCommand = command.sequence;
        switch (command.op) {
            case Op::SetLed: led = decodeSetLed(command.arguments); return effective();
            case Op::SetExposure: {
                exposure_ = decodeSetExposure(command.arguments);
                return encode(Granted{.exposureNs = exposure_.exposureUs * 1000ULL + 260,
                                      .gain = exposure_.gain,
                                      .effectiveFrame = decodeU32(effective())});
            }
            case Op::SetFormat: {
                format_ = decodeSetFormat(command.arguments);
                const std::uint32_t stride =
                    *strideOf(format_.format, format_.width / format_.binning);
                return encodeU32(stride *
                                     static_cast<std::uint32_t>(format_.height / format_.binning) +
                                 frameBytesOff);
            }
            case Op::Arm: return arm(decodeArm(command.arguments));
            case Op::Resend: resend(decodeResend(command.arguments)); return {};
            case Op::Flush: stream.clear(); return encodeU32(sequence_);
            case Op::Abort:
                led = {};
                state = RigState::Idle;
                return {};
            default: return {};
        }
    }

    Arguments effective() {
        effective_ = nextFrame_ + std::exchange(latency, 0);
        return encodeU32(effective_);
    }

    Arguments arm(const Arm& arguments) {
        const std::uint32_t first = nextFrame_;
        std::vector<Bytes> sent;
        for (int i = 0; i < arguments.frames; ++i) {
            FrameToSend frame = expose(arguments.captureId, i);
            if (onFrame) onFrame(frame);
            const std::vector<Bytes> chunks = toChunks(frame, sequence_);
            sequence_ += static_cast<std::uint32_t>(chunks.size());
            ram_[{arguments.captureId, i}] = chunks;
            sent.insert(sent.end(), chunks.begin(), chunks.end());
        }
        send(std::move(sent));
        return encodeU32(first);
    }

    FrameToSend expose(std::uint64_t captureId, int index) {
        const std::uint32_t number = nextFrame_++;
        int channels = 0;
        for (int c = 0; c < 3; ++c)
            channels |= led.levels[static_cast<std::size_t>(c)] != 0 ? 1 << c : 0;
        const Size size{format_.width / format_.binning, format_.height / format_.binning};
        return {.captureId = captureId,
                .index = index,
                .leader = {.format = format_.format,
                           .led = channels == 0 ? kDarkLed : led.led,
                           .channels = static_cast<std::uint8_t>(channels),
                           .exposureRequestedUs = exposure_.exposureUs,
                           .exposureGrantedNs = exposure_.exposureUs * 1000ULL + 260,
                           .gain = exposure_.gain,
                           .ledLevel = led.levels,
                           .blackLevel = 60,
                           .x = format_.x,
                           .y = format_.y,
                           .binning = format_.binning,
                           .frameNumber = number},
                .trailer = {.validity = validity::kAll},
                .pixels = picture(size, index),
                .bootId = ident.bootId};
    }

    [[nodiscard]] bool holds(const Resend& arguments) const {
        return ram_.contains({arguments.captureId, arguments.frame});
    }

    void resend(const Resend& arguments) {
        std::vector<Bytes> sent;
        const auto& chunks = ram_.at({arguments.captureId, arguments.frame});
        for (std::size_t i = arguments.firstChunk; i <= arguments.lastChunk && i < chunks.size();
             ++i) {
            sent.push_back(chunks[i]);
            restamp(sent.back(), sequence_++, true);
        }
        send(std::move(sent));
    }

    void send(std::vector<Bytes> chunks) {
        if (onStream) onStream(chunks);
        for (Bytes& chunk : chunks) stream.push_back(std::move(chunk));
    }

    Nanoseconds now_{0}, nextStatus_{0}, lastCommandAt_{0};
    std::uint16_t statusSequence_ = 0;
    Bytes lent_;  ///< the transfer that the caller has
    std::multimap<Nanoseconds, Report> inputs_;
    std::optional<Ack> lastAck_;
    std::deque<Event> events_;
    std::uint32_t eventsFrom_ = 0;
    SetExposure exposure_{};
    SetFormat format_{};
    std::uint32_t nextFrame_ = 1, effective_ = 1, sequence_ = 1;
    std::map<std::pair<std::uint64_t, int>, std::vector<Bytes>> ram_;
};

}  // namespace gonio::driver::test
