// What the rig tells of itself: IDENT, LIMITS, STATUS, and the feature reports that carry them.

#include <algorithm>
#include <cmath>

#include "sim/device.h"
#include "sim/frame_chunks.h"
#include "sim/light.h"

namespace gonio::sim {

using namespace driver;  // the wire's words

namespace {

constexpr std::int16_t kTooHot = 8500;  // 0.01 degC: past LIMITS' sensor_temperature
constexpr Nanoseconds kStatusPeriod = std::chrono::milliseconds(100);
constexpr Nanoseconds kStatusPause = std::chrono::milliseconds(10);  // between two on change

/// The levels at which all bands are as bright as the dimmest.
std::array<std::uint16_t, 3> whiteBalance() {
    double dimmest = ledRate(0, Band::R);
    for (Band b : kBands) dimmest = std::min(dimmest, ledRate(0, b));
    std::array<std::uint16_t, 3> levels{};
    for (Band b : kBands) {
        levels[index(b)] = static_cast<std::uint16_t>(std::lround(65535 * dimmest / ledRate(0, b)));
    }
    return levels;
}

}  // namespace

RigState Device::state() const {
    if (fault_ != 0) return RigState::Fault;
    if (!capture_) return RigState::Idle;
    if (capture_->software && !exposing_ && capture_->triggersWaiting == 0) return RigState::Armed;
    return RigState::Exposing;
}

Ident Device::ident() const {
    Ident v;
    v.hardwareRevision = 1;
    v.firmware = 0x00010000;
    v.capabilities = 0b110;  // binning, resend
    v.bootId = bootId_;
    v.sensorWidth = static_cast<std::uint16_t>(kSensorSize.width);
    v.sensorHeight = static_cast<std::uint16_t>(kSensorSize.height);
    v.bitDepth = static_cast<std::uint8_t>(digits_.bits);
    v.ledCount = static_cast<std::uint8_t>(config_.leds);
    for (std::size_t i = 0; i < v.ledCount; ++i) {
        v.ledAngle[i] = static_cast<std::int16_t>(std::lround(100 * kLedDegrees[i]));
    }
    v.wavelengthNm = {630, 525, 465};
    v.maxChunkPayload = config_.maxChunkPayload;
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
    v.binnings = config_.binnings;
    v.roiStep = kRoiStep;
    v.maxFrames = kMaxFrames;
    v.framePeriodUs = static_cast<std::uint32_t>(link().framePeriod.count() / 1000);
    v.blackLevel = digits_.blackLevel;
    v.fullScale = digits_.fullScale;
    v.ledFull = kFullCurrent;
    v.ledWhite = whiteBalance();
    v.ledTolerance = 100;
    v.ledTemperature = {0, 6000};
    v.sensorTemperature = {0, 8000};
    return v;
}

Temperatures Device::temperatures() const {
    const double board = 26 + drift_.boardKelvin();
    return {static_cast<std::int16_t>(std::lround(100 * board)),
            hot_ ? kTooHot : static_cast<std::int16_t>(std::lround(100 * config_.rig.celsius)),
            2500,
            2300};
}

Status Device::status() const {
    Status v;
    v.sequence = nextStatusSequence_;
    v.bootId = bootId_;
    v.timeUs = clockUs();
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
    v.lastCommand = claim_.lastCommand();
    v.captureId = capture_ ? capture_->id : 0;
    v.framesMade = stats_.framesMade;
    v.fifoFrames = static_cast<std::uint16_t>(frames_.framesWaiting());
    v.newestEvent = notices_.newestEvent();
    v.fault = fault_;
    v.owner = claim_.owner();
    return v;
}

void Device::raise(std::uint16_t code, std::uint32_t arg0, std::uint32_t arg1) {
    notices_.raise({.code = code, .arg0 = arg0, .arg1 = arg1}, clockUs());
}

void Device::pushStatus() {
    ++nextStatusSequence_;
    notices_.tell(status());
    statusAt_ = now_;
    nextStatusAt_ = now_ + kStatusPeriod;
}

/// Of several changes in a short time the last STATUS tells.
void Device::tellChange() {
    if (!statusAt_ || now_ - *statusAt_ >= kStatusPause) return pushStatus();
    nextStatusAt_ = std::min(nextStatusAt_, *statusAt_ + kStatusPause);
}

std::optional<Report> Device::getFeature(std::uint8_t id) {
    switch (static_cast<ReportId>(id)) {
        case ReportId::Ident: return encode(ident());
        case ReportId::Session: return encode(claim_.state(statusOfLastSet_));
        case ReportId::LastAck: return encode(claim_.newest(), ReportId::LastAck);
        case ReportId::Events: return encode(notices_.page());
        case ReportId::Stats:
            stats_.uptimeS = static_cast<std::uint32_t>((now_ - bootedAt_).count() / 1'000'000'000);
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
        notices_.readEventsFrom(decodeEventsFrom(report).value());
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

}  // namespace gonio::sim
