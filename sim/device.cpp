#include "sim/device.h"

#include <algorithm>
#include <cmath>

#include "driver/protocol/crc.h"
#include "driver/protocol/pixels.h"
#include "sim/frame_chunks.h"
#include "sim/random.h"

namespace gonio::sim {

using namespace driver;  // the wire's words

namespace {

constexpr std::size_t kFrameRam = 8;
constexpr std::uint16_t kMaxFrames = 256;
constexpr std::uint8_t kControlLatency = 2;
constexpr std::uint8_t kRoiStep = 4;
constexpr Nanoseconds kFramePeriod = std::chrono::milliseconds(40);  // full frame over USB 2
constexpr Nanoseconds kReadout = std::chrono::milliseconds(1);
constexpr Nanoseconds kStatusPeriod = std::chrono::milliseconds(100);
constexpr double kFullLevel = 65535;
constexpr std::size_t kStoredAcks = 8;
constexpr std::size_t kStoredEvents = 64;
constexpr std::size_t kInputQueue = 63;  // as hidraw keeps them

std::uint64_t microseconds(Nanoseconds t) { return static_cast<std::uint64_t>(t.count() / 1000); }

std::array<std::uint16_t, 3> currents(const std::array<std::uint16_t, 3>& levels) {
    std::array<std::uint16_t, 3> current{};
    for (std::size_t c = 0; c < 3; ++c) {
        current[c] = static_cast<std::uint16_t>((levels[c] * kFullCurrent[c] + 32767U) / 65535U);
    }
    return current;
}

}  // namespace

Device::Device(DeviceConfig config)
    : config_(std::move(config)),
      // The window that the host reads is centred on the sensor; so is the lens, up to its offset.
      optics_(config_.serial, {kSensorSize.width / 2.0, kSensorSize.height / 2.0}),
      sensor_(config_.serial, config_.sensorCelsius),
      bootId_(static_cast<std::uint32_t>(mixed(config_.seed, config_.bootCount))) {
    raise(event::kBoot, bootId_, 0);
}

void Device::place(Placement placement) {
    placement_ = std::move(placement);
    rates_.clear();
}

void Device::setInterlock(std::uint8_t bits) {
    const bool may = (bits & interlock::kMayLight) == interlock::kMayLight;
    const bool could = (interlock_ & interlock::kMayLight) == interlock::kMayLight;
    interlock_ = bits;
    if (could && !may) {
        raise(event::kInterlockOpened, bits, exposing_ ? exposing_->number : 0);
        if (current_.led >= 0) {
            abort(status::kInterlock);
            fault_ = status::kInterlock;
        }
    } else if (!could && may) {
        raise(event::kInterlockClosed, bits, 0);
    }
    pushStatus();
}

RigState Device::state() const {
    if (fault_ != 0) return RigState::Fault;
    if (!capture_) return RigState::Idle;
    if (capture_->software && !exposing_ && capture_->triggersWaiting == 0) return RigState::Armed;
    return RigState::Exposing;
}

// ---- reports
// --------------------------------------------------------------------------------------

Ident Device::ident() const {
    Ident v;
    v.hardwareRevision = 1;
    v.firmware = 0x00010000;
    v.capabilities = 0b110;  // binning, resend
    v.bootId = bootId_;
    v.sensorWidth = static_cast<std::uint16_t>(kSensorSize.width);
    v.sensorHeight = static_cast<std::uint16_t>(kSensorSize.height);
    v.ledCount = kLeds;
    for (std::size_t i = 0; i < kLeds; ++i) {
        v.ledAngle[i] = static_cast<std::int16_t>(std::lround(100 * kLedDegrees[i]));
    }
    v.wavelengthNm = {630, 525, 465};
    v.maxChunkPayload = kMaxChunkPayload;
    v.frameRam = kFrameRam;
    v.exposureMinUs = kExposureMinUs;
    v.exposureMaxUs = kExposureMaxUs;
    v.exposureStep = kExposureStep;
    v.controlLatency = kControlLatency;
    v.ledSettleMs = kSettleMs;
    return v;
}

Limits Device::limits() const {
    Limits v;
    v.formats = 0b11;
    v.binnings = 0b111;
    v.roiStep = kRoiStep;
    v.maxFrames = kMaxFrames;
    v.framePeriodUs = static_cast<std::uint32_t>(microseconds(kFramePeriod));
    v.blackLevel = kBlackLevel;
    v.fullScale = kFullScale;
    v.ledFull = kFullCurrent;
    double dimmest = ledRate(0, Band::R);
    for (Band b : kBands) dimmest = std::min(dimmest, ledRate(0, b));
    for (Band b : kBands) {
        v.ledWhite[index(b)] =
            static_cast<std::uint16_t>(std::lround(65535 * dimmest / ledRate(0, b)));
    }
    v.ledTolerance = 100;
    v.ledTemperature = {0, 6000};
    v.sensorTemperature = {0, 8000};
    return v;
}

Status Device::status() const {
    Status v;
    v.sequence = nextStatusSequence_;
    v.bootId = bootId_;
    v.timeUs = microseconds(now_);
    v.state = state();
    v.interlock = interlock_;
    if (current_.led >= 0) {
        for (unsigned c = 0; c < 3; ++c) {
            if (current_.levels[c] != 0)
                v.ledOn |= 1U << (3 * static_cast<unsigned>(current_.led) + c);
        }
        v.ledCurrent = currents(current_.levels);
    }
    v.temperature = temperatures();
    v.lastCommand = session_.lastCommand;
    v.captureId = capture_ ? capture_->id : 0;
    v.framesMade = stats_.framesMade;
    v.fifoFrames = 0;
    for (const auto& chunk : stream_) {
        if (chunk[5] == static_cast<std::uint8_t>(ChunkType::Trailer)) ++v.fifoFrames;
    }
    v.newestEvent = nextEventSequence_ - 1;
    v.fault = fault_;
    v.owner = session_.owner;
    return v;
}

std::optional<Report> Device::getFeature(std::uint8_t id) {
    switch (static_cast<ReportId>(id)) {
        case ReportId::Ident: return encode(ident());
        case ReportId::Session:
            return encode(SessionState{
                .sessionId = session_.id,
                .heartbeatMs = static_cast<std::uint16_t>(session_.heartbeat.count() / 1'000'000),
                .hostMinor = session_.hostMinor,
                .statusOfLastSet = statusOfLastSet_,
                .lastCommand = session_.lastCommand,
                .owner = session_.owner});
        case ReportId::LastAck:
            return encode(session_.stored.empty() ? Ack{.op = Op{}} : session_.stored.back().second,
                          ReportId::LastAck);
        case ReportId::Events: {
            EventsPage page{.oldest = events_.empty() ? 0 : events_.front().sequence,
                            .newest = nextEventSequence_ - 1,
                            .events = {}};
            for (const Event& e : events_) {
                if (e.sequence >= eventsFrom_ && page.events.size() < 2) page.events.push_back(e);
            }
            return encode(page);
        }
        case ReportId::Stats:
            stats_.uptimeS = static_cast<std::uint32_t>(now_.count() / 1'000'000'000);
            return encode(stats_);
        case ReportId::Limits: return encode(limits());
        case ReportId::Status: return encode(status());
        default: return std::nullopt;
    }
}

bool Device::setFeature(const Report& report) {
    const auto id = static_cast<ReportId>(report[0]);
    if (id != ReportId::Session && id != ReportId::Events) return false;
    if (!crcAgrees(report)) {
        ++stats_.crcRejects;
        if (id == ReportId::Session) statusOfLastSet_ = status::kBadCrc;
        return true;
    }
    if (id == ReportId::Events) {
        eventsFrom_ = decodeEventsFrom(report).value();
        return true;
    }
    const Result<SessionSet> set = decodeSessionSet(report);
    if (!set) {
        statusOfLastSet_ = status::kBadArg;
        return true;
    }
    claimOrRelease(*set);
    return true;
}

void Device::claimOrRelease(const SessionSet& set) {
    const auto low = [](std::uint64_t id) { return static_cast<std::uint32_t>(id); };
    if (set.release) {
        if (session_.owner == Owner::None || session_.id != set.sessionId) {
            statusOfLastSet_ = status::kNotOwner;
            return;
        }
        abort(0);
        flush();
        raise(event::kEnded, low(session_.id), 0);
        session_ = {};
        statusOfLastSet_ = status::kOk;
        pushStatus();
        return;
    }
    if (low(set.sessionId) == 0 || set.heartbeatMs < 500 || set.heartbeatMs > 10000) {
        statusOfLastSet_ = status::kBadArg;
        return;
    }
    if (session_.owner == Owner::Alive && session_.id != set.sessionId) {
        statusOfLastSet_ = status::kBusy;
        return;
    }
    if (session_.id != set.sessionId) {
        if (session_.owner == Owner::Lapsed) raise(event::kEnded, low(session_.id), 1);
        startClean();
        session_.id = set.sessionId;
    }
    session_.owner = Owner::Alive;
    session_.heartbeat = std::chrono::milliseconds(set.heartbeatMs);
    session_.hostMinor = set.hostMinor;
    session_.lastCommandAt = now_;
    statusOfLastSet_ = status::kOk;
    raise(event::kClaimed, low(set.sessionId), 0);
    pushStatus();
}

void Device::startClean() {
    abort(0);
    flush();
    session_ = {};
    current_ = {};
    due_.clear();
    format_ = {};
    frameRam_.clear();
}

void Device::raise(std::uint16_t code, std::uint32_t arg0, std::uint32_t arg1) {
    events_.push_back({.sequence = nextEventSequence_++,
                       .timeUs = microseconds(now_),
                       .code = code,
                       .arg0 = arg0,
                       .arg1 = arg1});
    if (events_.size() > kStoredEvents) events_.pop_front();
    inputs_.push_back(encode(events_.back()));
}

void Device::pushStatus() {
    ++nextStatusSequence_;
    inputs_.push_back(encode(status()));
    nextStatusAt_ = now_ + kStatusPeriod;
    // The host's queue keeps the oldest; what does not fit is lost.
    while (inputs_.size() > kInputQueue) inputs_.pop_back();
}

std::optional<Report> Device::takeInput() {
    if (inputs_.empty()) return std::nullopt;
    const Report report = inputs_.front();
    inputs_.pop_front();
    return report;
}

std::optional<std::vector<std::uint8_t>> Device::takeBulk() {
    if (stream_.empty()) return std::nullopt;
    std::vector<std::uint8_t> chunk = std::move(stream_.front());
    stream_.pop_front();
    return chunk;
}

// ---- commands
// -------------------------------------------------------------------------------------

void Device::output(const Report& report) {
    const Result<Command> command = decodeCommand(report);
    if (!command) {
        ++stats_.crcRejects;
        return;
    }
    const Ack ack = execute(*command);
    inputs_.push_back(encode(ack));
}

Ack Device::execute(const Command& command) {
    Ack ack{.sequence = command.sequence, .op = command.op, .sessionLow = command.sessionLow};
    if (session_.owner != Owner::Alive ||
        command.sessionLow != static_cast<std::uint32_t>(session_.id)) {
        ack.status = status::kNotOwner;
        return ack;
    }
    session_.lastCommandAt = now_;
    for (const auto& [before, answer] : session_.stored) {
        if (before.sequence != command.sequence) continue;
        if (before == command) {
            ++stats_.replays;
            return answer;
        }
        ack.status = status::kBadSeq;
        return ack;
    }
    const auto ahead = static_cast<std::uint16_t>(command.sequence - session_.lastCommand);
    if (command.sequence == 0 || ahead == 0 || ahead > 32767) {
        ack.status = status::kBadSeq;
        return ack;
    }
    switch (command.op) {
        case Op::Ping: ack.result = encodeU64(microseconds(now_)); break;
        case Op::SetLed: ack.status = setLed(decodeSetLed(command.arguments), ack.result); break;
        case Op::SetExposure:
            ack.status = setExposure(decodeSetExposure(command.arguments), ack.result);
            break;
        case Op::SetFormat:
            ack.status = setFormat(decodeSetFormat(command.arguments), ack.result);
            break;
        case Op::Arm: ack.status = arm(decodeArm(command.arguments), ack.result); break;
        case Op::Trigger: ack.status = trigger(decodeU64(command.arguments), ack.result); break;
        case Op::Abort: abort(0); break;
        case Op::Resend: ack.status = resend(decodeResend(command.arguments)); break;
        case Op::Flush:
            flush();
            ack.result = encodeU32(nextStreamSequence_);
            break;
        case Op::SyncTime: ack.result = encodeU64(microseconds(now_)); break;
        case Op::ClearFault:
            if (fault_ == status::kInterlock &&
                (interlock_ & interlock::kMayLight) != interlock::kMayLight) {
                ack.status = fault_;
            } else {
                fault_ = 0;
            }
            break;
        case Op::Reboot:
            abort(0);
            startClean();
            ++config_.bootCount;
            bootId_ = static_cast<std::uint32_t>(mixed(config_.seed, config_.bootCount));
            raise(event::kBoot, bootId_, 0);
            return ack;
        default: ack.status = status::kUnsupported; break;
    }
    if (ack.status != status::kOk) ack.result = {};
    session_.lastCommand = command.sequence;
    ++stats_.commandsDone;
    session_.stored.emplace_back(command, ack);
    if (session_.stored.size() > kStoredAcks) session_.stored.pop_front();
    return ack;
}

std::uint32_t Device::applySettings(const Settings& wanted) {
    if (exposing_ && freeRunning()) {
        const std::uint32_t effective = exposing_->number + kControlLatency;
        due_.emplace_back(effective, wanted);
        return effective;
    }
    const bool ledChanged = wanted.led != current_.led || wanted.levels != current_.levels;
    current_ = wanted;
    if (ledChanged && wanted.led >= 0) settledAt_ = now_ + std::chrono::milliseconds(kSettleMs);
    return nextFrame_;
}

std::uint16_t Device::setLed(const SetLed& args, Arguments& result) {
    if (args.led >= kLeds) return status::kBadArg;
    const bool dark = args.levels == std::array<std::uint16_t, 3>{};
    if (!dark) {
        if (fault_ != 0) return fault_;
        if ((interlock_ & interlock::kMayLight) != interlock::kMayLight) return status::kInterlock;
    }
    Settings wanted = due_.empty() ? current_ : due_.back().second;
    wanted.led = dark ? -1 : args.led;
    wanted.levels = args.levels;
    result = encodeU32(applySettings(wanted));
    pushStatus();
    return status::kOk;
}

std::uint16_t Device::setExposure(const SetExposure& args, Arguments& result) {
    if (args.exposureUs < kExposureMinUs || args.exposureUs > kExposureMaxUs || args.gain != 0) {
        return status::kBadArg;
    }
    Settings wanted = due_.empty() ? current_ : due_.back().second;
    wanted.exposureUs = args.exposureUs;
    wanted.gain = args.gain;
    result = encode(
        Granted{.exposureNs = static_cast<std::uint64_t>(grantedExposure(args.exposureUs).count()),
                .gain = args.gain,
                .effectiveFrame = applySettings(wanted)});
    return status::kOk;
}

std::uint16_t Device::setFormat(const SetFormat& args, Arguments& result) {
    if (capture_) return status::kBadState;
    const bool binning = args.binning == 1 || args.binning == 2 || args.binning == 4;
    const auto stepped = [&](std::uint16_t v) {
        return v % kRoiStep == 0 && (!binning || v % args.binning == 0);
    };
    const bool fits = args.width > 0 && args.height > 0 &&
                      args.x + args.width <= kSensorSize.width &&
                      args.y + args.height <= kSensorSize.height;
    const auto stride = strideOf(args.format, args.width / std::max<int>(1, args.binning));
    if (!binning || !fits || !stride || !stepped(args.x) || !stepped(args.y) ||
        !stepped(args.width) || !stepped(args.height)) {
        return status::kBadArg;
    }
    format_ = {.format = args.format,
               .view = {.x = args.x, .y = args.y, .size = {args.width, args.height}},
               .binning = args.binning};
    result = encodeU32(*stride * static_cast<std::uint32_t>(args.height / args.binning));
    return status::kOk;
}

std::uint16_t Device::arm(const Arm& args, Arguments& result) {
    if (fault_ != 0) return fault_;
    if (capture_) return status::kBadState;
    const bool held = std::any_of(frameRam_.begin(), frameRam_.end(), [&](const StoredFrame& f) {
        return f.capture == args.captureId;
    });
    if (args.captureId == 0 || held || args.frames == 0 || args.frames > kMaxFrames ||
        args.trigger > 1) {
        return status::kBadArg;
    }
    capture_ = Capture{.id = args.captureId, .frames = args.frames, .software = args.trigger == 1};
    result = encodeU32(nextFrame_);
    earliestStart_ = std::max(earliestStart_, now_);
    beginExposureIfDue();
    pushStatus();
    return status::kOk;
}

std::uint16_t Device::trigger(std::uint64_t captureId, Arguments& result) {
    if (!capture_ || !capture_->software || exposing_ || capture_->triggersWaiting > 0) {
        return status::kBadState;
    }
    if (capture_->id != captureId) return status::kBadArg;
    capture_->triggersWaiting = 1;
    result = encodeU32(nextFrame_);
    beginExposureIfDue();
    return status::kOk;
}

std::uint16_t Device::resend(const Resend& args) {
    const auto frame = std::find_if(frameRam_.begin(), frameRam_.end(), [&](const StoredFrame& f) {
        return f.capture == args.captureId && f.index == args.frame;
    });
    if (frame == frameRam_.end()) {
        ++stats_.framesGone;
        return status::kFrameGone;
    }
    const std::size_t last = args.lastChunk == 0xFFFF ? frame->chunks.size() - 1 : args.lastChunk;
    if (args.firstChunk > last || last >= frame->chunks.size()) return status::kBadRange;
    for (std::size_t i = args.firstChunk; i <= last; ++i) {
        queueChunk(frame->chunks[i], true);
        ++stats_.resends;
    }
    return status::kOk;
}

void Device::goDark() {
    current_.led = -1;
    current_.levels = {};
    for (auto& [frame, settings] : due_) {
        settings.led = -1;
        settings.levels = {};
    }
}

std::array<std::int16_t, 4> Device::temperatures() const {
    return {2600, static_cast<std::int16_t>(std::lround(100 * config_.sensorCelsius)), 2500, 2300};
}

void Device::abort(std::uint16_t reason) {
    // What was acknowledged and waits for its frame holds from now on, the LEDs excepted.
    if (!due_.empty()) current_ = due_.back().second;
    due_.clear();
    goDark();
    if (exposing_ && capture_) {
        ChunkHeader header{.type = ChunkType::Aborted,
                           .bootId = bootId_,
                           .captureId = capture_->id,
                           .frameIndex = static_cast<std::uint16_t>(capture_->next),
                           .timeUs = microseconds(now_)};
        queueChunk(encodeChunk(header,
                               encode(Aborted{.reason = reason, .frameNumber = exposing_->number})),
                   false);
    }
    exposing_.reset();
    capture_.reset();
    pushStatus();
}

void Device::flush() { stream_.clear(); }

void Device::resetStream() { flush(); }

// ---- time
// -----------------------------------------------------------------------------------------

void Device::checkHeartbeat() {
    if (session_.owner != Owner::Alive || now_ - session_.lastCommandAt < session_.heartbeat)
        return;
    lapse(status::kHeartbeat);
    raise(event::kHeartbeatLost,
          static_cast<std::uint32_t>((now_ - session_.lastCommandAt).count() / 1'000'000),
          static_cast<std::uint32_t>(session_.id));
    pushStatus();
}

/// Control is lost: dark, and what the rig was doing ends. Frame RAM and ACKs stay.
void Device::lapse(std::uint16_t reason) {
    if (session_.owner == Owner::Alive) {
        session_.owner = Owner::Lapsed;
        ++stats_.lapses;
    }
    abort(reason);
    flush();
}

void Device::linkLost() {
    constexpr std::uint32_t kBusReset = 1;
    lapse(status::kLink);
    raise(event::kLinkLost, kBusReset, 0);
    pushStatus();
}

void Device::beginExposureIfDue() {
    if (!capture_ || exposing_ || fault_ != 0) return;
    if (capture_->software && capture_->triggersWaiting == 0) return;
    // Frames that are not wholly sent fill the RAM: the next exposure waits.
    std::size_t waiting = 0;
    for (const auto& chunk : stream_)
        waiting += chunk[5] == static_cast<std::uint8_t>(ChunkType::Trailer);
    if (waiting >= kFrameRam) return;
    while (!due_.empty() && due_.front().first <= nextFrame_) {
        const Settings& wanted = due_.front().second;
        if (wanted.led >= 0 && (wanted.led != current_.led || wanted.levels != current_.levels)) {
            settledAt_ = now_ + std::chrono::milliseconds(kSettleMs);
        }
        current_ = wanted;
        due_.pop_front();
    }
    Exposing exposing;
    exposing.settings = current_;
    exposing.number = nextFrame_++;
    exposing.start = std::max({now_, earliestStart_, settledAt_});
    exposing.end = exposing.start + grantedExposure(current_.exposureUs);
    exposing_ = exposing;
    earliestStart_ =
        exposing.start + std::max(kFramePeriod, grantedExposure(current_.exposureUs) + kReadout);
    capture_->triggersWaiting = 0;
}

const RateImages& Device::rates(int led) {
    if (!field_ || field_->view() != format_.view) {
        rates_.clear();
        field_.emplace(optics_, format_.view);
    }
    const auto found = rates_.find(led);
    if (found != rates_.end()) return found->second;
    return rates_.emplace(led, rateImages(placement_, config_.errors, optics_, *field_, led))
        .first->second;
}

void Device::finishExposure() {
    const Exposing done = *exposing_;
    const int index = capture_->next;
    exposing_.reset();
    ++stats_.framesMade;
    queueFrame(done, index);
    ++capture_->next;
    if (capture_->next >= capture_->frames) {
        capture_.reset();
        for (const auto& [frame, settings] : due_) current_ = settings;
        due_.clear();
        pushStatus();
    }
}

Image<std::uint16_t> Device::exposed(const Settings& s, const NoiseKey& key) {
    const auto expose = [&](const Image<float>* rate, double level) {
        return sensor_.expose(
            rate, level, grantedExposure(s.exposureUs), format_.view, key, format_.binning);
    };
    if (s.led < 0) return expose(nullptr, 1);
    const RateImages& images = rates(s.led);
    // One band is lit at a time in a measurement; several together add their light.
    const auto isLit = [](std::uint16_t level) { return level != 0; };
    if (std::count_if(s.levels.begin(), s.levels.end(), isLit) == 1) {
        const auto lit = std::find_if(s.levels.begin(), s.levels.end(), isLit);
        const auto band = static_cast<std::size_t>(lit - s.levels.begin());
        return expose(&images[band], *lit / kFullLevel);
    }
    Image<float> sum(format_.view.size);
    for (std::size_t c = 0; c < 3; ++c) {
        const auto share = static_cast<float>(s.levels[c] / kFullLevel);
        for (std::size_t i = 0; i < sum.pixels().size(); ++i) {
            sum.pixels()[i] += share * images[c].pixels()[i];
        }
    }
    return expose(&sum, 1);
}

Leader Device::leaderOf(const Exposing& done, Size sent) const {
    const Settings& s = done.settings;
    Leader leader;
    leader.width = static_cast<std::uint16_t>(sent.width);
    leader.height = static_cast<std::uint16_t>(sent.height);
    leader.stride = *strideOf(format_.format, sent.width);
    leader.format = format_.format;
    leader.led = s.led >= 0 ? static_cast<std::uint8_t>(s.led) : kDarkLed;
    for (unsigned c = 0; c < 3; ++c) {
        if (s.led >= 0 && s.levels[c] != 0) leader.channels |= static_cast<std::uint8_t>(1U << c);
    }
    leader.exposureRequestedUs = s.exposureUs;
    leader.exposureGrantedNs = static_cast<std::uint64_t>(grantedExposure(s.exposureUs).count());
    leader.gain = s.gain;
    if (s.led >= 0) leader.ledLevel = s.levels;
    leader.temperature = temperatures();
    leader.blackLevel = kBlackLevel;
    leader.x = static_cast<std::uint16_t>(format_.view.x);
    leader.y = static_cast<std::uint16_t>(format_.view.y);
    leader.binning = static_cast<std::uint8_t>(format_.binning);
    leader.frameBytes = leader.stride * static_cast<std::uint32_t>(sent.height);
    leader.exposureStartUs = microseconds(done.start);
    leader.frameNumber = done.number;
    return leader;
}

Trailer Device::trailerOf(const Exposing& done, const Image<std::uint16_t>& image) const {
    Trailer trailer;
    trailer.exposureEndUs = microseconds(done.end);
    if (done.settings.led >= 0) {
        trailer.currentMin = trailer.currentMax = currents(done.settings.levels);
    }
    const bool seated = (interlock_ & interlock::kMayLight) == interlock::kMayLight;
    trailer.validity = seated ? validity::kAll : validity::kCurrent | validity::kTemperature;
    trailer.saturatedPixels = static_cast<std::uint32_t>(
        std::count(image.pixels().begin(), image.pixels().end(), kFullScale));
    return trailer;
}

void Device::queueFrame(const Exposing& done, int index) {
    const NoiseKey key{.seed = config_.seed,
                       .planStep = capture_->id >> 16,
                       .frameIndex = static_cast<std::uint64_t>(index)};
    const Image<std::uint16_t> image = exposed(done.settings, key);
    const std::vector<std::uint8_t> bytes = packPixels(image, format_.format);
    Trailer trailer = trailerOf(done, image);
    trailer.frameBytes = static_cast<std::uint32_t>(bytes.size());
    trailer.frameCrc = crc32c(bytes);
    const ChunkHeader header{.bootId = bootId_,
                             .captureId = capture_->id,
                             .frameIndex = static_cast<std::uint16_t>(index),
                             .timeUs = microseconds(now_)};
    StoredFrame stored{.capture = capture_->id,
                       .index = index,
                       .chunks = frameChunks(header, leaderOf(done, image.size()), bytes, trailer)};
    for (const auto& chunk : stored.chunks) queueChunk(chunk, false);
    frameRam_.push_back(std::move(stored));
    if (frameRam_.size() > kFrameRam) frameRam_.pop_front();
}

void Device::queueChunk(std::vector<std::uint8_t> chunk, bool resent) {
    restamp(chunk, nextStreamSequence_++, resent);
    stream_.push_back(std::move(chunk));
}

Nanoseconds Device::nextEvent() const {
    Nanoseconds next = nextStatusAt_;
    if (exposing_) next = std::min(next, exposing_->end);
    if (session_.owner == Owner::Alive) {
        next = std::min(next, session_.lastCommandAt + session_.heartbeat);
    }
    return std::max(next, now_);
}

void Device::advanceTo(Nanoseconds to) {
    while (true) {
        beginExposureIfDue();
        const Nanoseconds next = nextEvent();
        if (next > to) break;
        now_ = next;
        if (exposing_ && exposing_->end <= now_) finishExposure();
        checkHeartbeat();
        if (nextStatusAt_ <= now_) pushStatus();
    }
    now_ = std::max(now_, to);
}

}  // namespace gonio::sim
