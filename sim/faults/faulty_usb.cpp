#include "sim/faults/faulty_usb.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "driver/protocol/chunk.h"
#include "driver/protocol/reports.h"
#include "driver/protocol/wire.h"

namespace gonio::sim {
namespace {

constexpr int kPlenty = std::numeric_limits<int>::max();

UsbReply without(UsbAnswer answer) { return {.answer = answer, .data = {}}; }

std::optional<FrameFlaw> flawOf(FaultKind kind) {
    switch (kind) {
        case FaultKind::PreviousFrame: return FrameFlaw::PreviousAgain;
        case FaultKind::BlackFrame: return FrameFlaw::Black;
        case FaultKind::UnlitLed: return FrameFlaw::Unlit;
        case FaultKind::LateSettings: return FrameFlaw::LateSettings;
        case FaultKind::HiddenLateSettings: return FrameFlaw::HiddenLateSettings;
        case FaultKind::OldExposure: return FrameFlaw::OldExposure;
        case FaultKind::Reflex: return FrameFlaw::Reflex;
        case FaultKind::LedDrift: return FrameFlaw::LedDrift;
        default: return std::nullopt;
    }
}

/// What undoes a fault that lasts for a while.
std::optional<FaultKind> endOf(FaultKind kind) {
    switch (kind) {
        case FaultKind::Unplug:
        case FaultKind::UnplugQuietly:
        case FaultKind::PlugAs: return FaultKind::Plug;
        case FaultKind::LosePower: return FaultKind::PlugRebooted;
        case FaultKind::OpenInterlock: return FaultKind::CloseInterlock;
        case FaultKind::Overheat: return FaultKind::CoolDown;
        case FaultKind::Hang: return FaultKind::EndHang;
        case FaultKind::LimitTransfers: return FaultKind::EndLimit;
        default: return std::nullopt;
    }
}

}  // namespace

FaultyUsb::FaultyUsb(DeviceConfig config, UsbIds ids)
    : config_(config), usb_(std::move(config), ids), mostTransfers_(kPlenty) {
    usb_.takeChunksFrom([this] { return nextChunk(); });
    usb_.onFlush([this] { chunks_.clear(); });
}

void FaultyUsb::play(FaultScript script) {
    const auto comesAgain = [](const FaultRule& rule) {
        return std::any_of(rule.faults.begin(), rule.faults.end(), [](const Fault& fault) {
            return fault.kind == FaultKind::StaleFrame;
        });
    };
    if (std::any_of(script.rules.begin(), script.rules.end(), comesAgain)) chunks_.rememberFrames();
    FaultPlayer player(std::move(script), now());
    player.takeEnds(player_);
    player_ = std::move(player);
    framesSent_ = 0;
    chunkOfFrame_ = -1;
    device().flawFrames([this] { return flawOfExposure(); });
    while (auto due = player_.timed(now())) apply(*due);
}

void FaultyUsb::cause(const DueFault& fault) { apply(fault); }

// ---- time

void FaultyUsb::advanceTo(Nanoseconds to) {
    while (player_.next() <= to) {
        device().advanceTo(std::max(player_.next(), now()));
        if (const auto due = player_.timed(now())) apply(*due);
    }
    device().advanceTo(to);
    if (stranger_) stranger_->device().advanceTo(to);
}

Nanoseconds FaultyUsb::nextEvent() const {
    const Nanoseconds next = std::min(player_.next(), reports_.nextEvent(now()));
    return std::max(now(), std::min(usb_.device().nextEvent(), next));
}

// ---- faults

void FaultyUsb::applyAll(const std::vector<DueFault>& faults) {
    for (const DueFault& fault : faults) apply(fault);
}

void FaultyUsb::putOff(const std::vector<DueFault>& faults) {
    for (const DueFault& fault : faults) player_.later(now(), fault);
}

/// The cable has two ends, as it lies there with the rig's power or without.
Nanoseconds& FaultyUsb::endOfCondition(FaultKind end) {
    return endsAt_[end == FaultKind::PlugRebooted ? FaultKind::Plug : end];
}

/// Of several at the same thing the last end counts, and none where one has no end.
void FaultyUsb::endLater(const DueFault& fault) {
    const auto kind = fault.kind == FaultKind::HangUntilReset ? FaultKind::Hang : fault.kind;
    const auto end = endOf(kind);
    if (!end) return;
    Nanoseconds& until = endOfCondition(*end);
    if (fault.lasting <= Nanoseconds(0)) {
        // Another rig that is there for good is no state that ends.
        until = kind == FaultKind::PlugAs ? Nanoseconds(0) : Nanoseconds::max();
        return;
    }
    until = std::max(until, now() + fault.lasting);
    player_.later(now() + fault.lasting, DueFault{.kind = *end, .isEnd = true});
}

/// Nothing is to be done at this end.
bool FaultyUsb::isNoEnd(const DueFault& end) const {
    if (!end.isEnd) return false;
    const auto kind = end.kind == FaultKind::PlugRebooted ? FaultKind::Plug : end.kind;
    const auto until = endsAt_.find(kind);
    const bool over = until == endsAt_.end() || until->second == Nanoseconds(0);
    return over || now() < until->second;
}

void FaultyUsb::apply(const DueFault& fault) {
    if (isNoEnd(fault)) return;
    endLater(fault);
    if (spoilsChunks(fault.kind)) return chunks_.put(fault);
    if (flawOf(fault.kind)) return flaws_.push_back(fault.kind);
    if (reports_.put(fault, now())) return;
    if (fault.kind == FaultKind::LoseCommand) {
        ++commandsToLose_;
        return;
    }
    if (applyToRig(fault) || answers_.put(fault)) tally_.add(fault.kind);
    // A host reads descriptors when a device is plugged in, and no more.
    if (fault.kind == FaultKind::Malform && malformsDescriptors(fault.name)) plugIn({});
}

/// False: the fault is another's business.
bool FaultyUsb::applyToRig(const DueFault& fault) {
    switch (fault.kind) {
        case FaultKind::Unplug: unplug(); return true;
        case FaultKind::LosePower:
            unplug();
            powerLost_ = true;
            return true;
        case FaultKind::UnplugQuietly: unplug(true); return true;
        case FaultKind::Plug: plug(); return true;
        case FaultKind::PlugRebooted:
            powerLost_ = true;
            plugIn({});
            return true;
        case FaultKind::PlugAs: plugIn(fault.name); return true;
        case FaultKind::Hang:
        case FaultKind::HangUntilReset:
            hung_ = true;
            hungUntilReset_ = hungUntilReset_ || fault.kind == FaultKind::HangUntilReset;
            return true;
        case FaultKind::LimitTransfers: mostTransfers_ = fault.count; return true;
        case FaultKind::EndHang:
            endsAt_.erase(fault.kind);
            hung_ = hungUntilReset_ = false;
            return true;
        case FaultKind::EndLimit:
            endsAt_.erase(fault.kind);
            mostTransfers_ = kPlenty;
            return true;
        case FaultKind::UnknownChunk:
            if (!device().capturing()) {  // of no capture it would be stale before it is unknown
                ++unknownChunksDue_;
                return false;
            }
            device().sendUnknownChunk();
            return true;
        case FaultKind::UnknownEvent: device().tellUnknownEvent(); return true;
        case FaultKind::PileUpReports: device().pileUpReports(fault.count); return true;
        case FaultKind::OpenInterlock: device().setInterlock(0); return true;
        case FaultKind::CloseInterlock:
            endsAt_.erase(fault.kind);
            device().setInterlock(driver::interlock::kMayLight);
            return true;
        case FaultKind::Overheat: device().overheat(true); return true;
        case FaultKind::CoolDown:
            endsAt_.erase(fault.kind);
            device().overheat(false);
            return true;
        case FaultKind::JumpClock:
            device().jumpClock(static_cast<std::uint64_t>(fault.time.count() / 1000));
            return true;
        case FaultKind::WrapClock: {
            constexpr std::uint64_t kBefore = 100'000;  // us before it wraps
            device().jumpClock(0 - device().clockUs() - kBefore);
            return true;
        }
        default: return false;
    }
}

std::vector<std::uint8_t> FaultyUsb::deviceDescriptor() {
    auto descriptor = usb().deviceDescriptor();
    answers_.spoilDevice(descriptor);
    return descriptor;
}

std::vector<std::uint8_t> FaultyUsb::configDescriptor() {
    auto descriptors = usb().configDescriptor();
    answers_.spoilConfig(descriptors);
    return descriptors;
}

FrameFlaw FaultyUsb::flawOfExposure() {
    for (const DueFault& fault : player_.exposureBegins()) {
        if (flawOf(fault.kind)) {
            flaws_.push_back(fault.kind);
        } else {
            player_.later(now(), fault);  // not in the middle of what the rig is doing
        }
    }
    for (; unknownChunksDue_ > 0; --unknownChunksDue_)
        player_.later(now(), DueFault{.kind = FaultKind::UnknownChunk});
    if (flaws_.empty()) return FrameFlaw::None;
    const FaultKind kind = flaws_.front();
    flaws_.pop_front();
    tally_.add(kind);
    return *flawOf(kind);
}

// ---- the cable

void FaultyUsb::unplug(bool quietly) {
    if (!plugged_) return;
    plugged_ = false;
    quietly_ = quietly;
    errorDue_ = !quietly;
    hung_ = hungUntilReset_ = false;
    endsAt_.erase(FaultKind::EndHang);
    ++pulls_;
    pulledAt_ = now();
    backSince_.reset();
    chunks_.clear();
    reports_.clear();
    if (!stranger_) usb_.reset(UsbDevice::Loss::Power);
    stranger_.reset();
}

void FaultyUsb::plugIn(const std::string& otherSerial) {
    unplug();
    plugged_ = true;
    reports_.plugged();
    if (otherSerial.empty()) {
        endsAt_.erase(FaultKind::Plug);
        if (std::exchange(powerLost_, false)) device().powerCycle();
        backSince_ = now();
        return;
    }
    DeviceConfig other = config_;
    other.serial = otherSerial;
    ++other.seed;
    stranger_ = std::make_unique<UsbDevice>(std::move(other), ids());
    stranger_->device().advanceTo(now());
}

void FaultyUsb::resetPort() {
    if (!plugged_) return;
    ++portResets_;
    if (hungUntilReset_) {
        hung_ = hungUntilReset_ = false;
        endsAt_.erase(FaultKind::EndHang);
    }
    chunks_.clear();
    reports_.clear();
    reports_.plugged();
    usb().reset();
}

// ---- the doors

UsbReply FaultyUsb::control(const UsbSetup& setup, std::span<const std::uint8_t> out) {
    constexpr std::uint8_t kSetReport = 9, kOutput = 2, kToInterface = 0x21;
    constexpr std::uint8_t kClearFeature = 1, kOfEndpoint = 0x02;
    constexpr std::uint8_t kGetStatus = 0, kStatusOfEndpoint = 0x82;
    constexpr std::uint8_t kFromDevice = 0x80, kGetDescriptor = 6, kDeviceType = 1, kConfigType = 2;
    if (!plugged_) return without(UsbAnswer::Gone);
    if (hung_) return without(UsbAnswer::Nak);
    if (setup.requestType == kToInterface && setup.request == kSetReport &&
        setup.value >> 8 == kOutput && out.size() == driver::kReportBytes)
        return interruptOut(out);
    if (setup.requestType == kOfEndpoint && setup.request == kClearFeature &&
        setup.index == usb::kInterruptIn)
        reports_.haltCleared(now());
    UsbReply reply = usb().control(setup, out);
    if (setup.requestType == kStatusOfEndpoint && setup.request == kGetStatus &&
        setup.index == usb::kInterruptIn && !reply.data.empty())
        reply.data.front() = reports_.stalled() ? 1 : 0;
    if (backSince_ && device().claimed()) {
        reclaimed_ = std::max(reclaimed_, now() - *backSince_);
        backSince_.reset();
    }
    answers_.spoil(setup, reply);
    if (setup.requestType != kFromDevice || setup.request != kGetDescriptor) return reply;
    if (setup.value == kDeviceType << 8) reply.data = deviceDescriptor();
    if (setup.value == kConfigType << 8) reply.data = configDescriptor();
    reply.data.resize(std::min<std::size_t>(reply.data.size(), setup.length));
    return reply;
}

UsbReply FaultyUsb::interruptIn() {
    if (!plugged_) return without(UsbAnswer::Gone);
    if (hung_) return without(UsbAnswer::Nak);
    if (stranger_) return stranger_->interruptIn();
    if (reports_.stalled()) return without(UsbAnswer::Stall);
    const auto report = reports_.next(device());
    if (!report) return without(UsbAnswer::Nak);
    return {.answer = UsbAnswer::Done, .data = {report->begin(), report->end()}};
}

UsbReply FaultyUsb::interruptOut(std::span<const std::uint8_t> report) {
    if (!plugged_) return without(UsbAnswer::Gone);
    if (hung_) return without(UsbAnswer::Nak);
    if (stranger_ || report.size() != driver::kReportBytes) return usb().interruptOut(report);
    const auto op = static_cast<driver::Op>(report[7]);
    applyAll(player_.onCommand(op));
    if (!plugged_) return without(UsbAnswer::Gone);
    if (commandsToLose_ > 0) {
        --commandsToLose_;
        tally_.add(FaultKind::LoseCommand);
        return {};
    }
    UsbReply reply = usb_.interruptOut(report);
    if (device().takeReboot()) {
        constexpr auto kAcknowledged = std::chrono::milliseconds(50);
        constexpr auto kBoots = std::chrono::milliseconds(500);
        player_.later(now() + kAcknowledged,
                      DueFault{.kind = FaultKind::LosePower, .lasting = kBoots});
    }
    putOff(player_.afterCommand(op));
    return reply;
}

UsbReply FaultyUsb::bulkIn(std::size_t length) {
    if (!plugged_)
        return without(std::exchange(errorDue_, false) ? UsbAnswer::Error : UsbAnswer::Gone);
    if (hung_) return without(UsbAnswer::Nak);
    UsbReply reply = usb().bulkIn(length);
    if (!plugged_) return bulkIn(length);  // at this very chunk
    if (reply.answer != UsbAnswer::Nak || stranger_) return reply;
    reply.answer = chunks_.answer();
    if (reply.answer == UsbAnswer::Stall) usb_.haltStream();
    return reply;
}

std::optional<ChunkBytes> FaultyUsb::nextChunk() {
    while (true) {
        if (auto ready = chunks_.ready()) return ready;
        auto chunk = fetchChunk();
        if (!chunk) return std::nullopt;
        auto sent = chunks_.through(std::move(*chunk), [this] { return fetchChunk(); });
        if (sent) return sent;
        if (chunks_.failed()) return std::nullopt;
    }
}

/// The rig's next chunk, with all that goes wrong at it put in its way.
std::optional<ChunkBytes> FaultyUsb::fetchChunk() {
    constexpr std::size_t kTypeByte = 5, kFlagsByte = 30;
    auto chunk = device().takeBulk();
    if (!chunk) return chunk;
    const auto type = static_cast<driver::ChunkType>((*chunk)[kTypeByte]);
    const bool resent = ((*chunk)[kFlagsByte] & 1) != 0;
    if (!resent) {
        if (type == driver::ChunkType::Leader) {
            ++framesSent_;
            chunkOfFrame_ = -1;
        }
        ++chunkOfFrame_;
    }
    applyAll(player_.chunkSent({.frame = resent ? 0 : framesSent_, .chunk = chunkOfFrame_}));
    if (!resent && type == driver::ChunkType::Trailer) putOff(player_.frameSent());
    if (!plugged_) return std::nullopt;
    return chunk;
}

}  // namespace gonio::sim
