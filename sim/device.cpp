#include "sim/device.h"

#include <algorithm>
#include <utility>

#include "driver/protocol/crc.h"
#include "driver/protocol/pixels.h"
#include "sim/frame_chunks.h"
#include "sim/light.h"
#include "sim/random.h"

namespace gonio::sim {

using namespace driver;  // the wire's words

namespace {

constexpr Nanoseconds kReadout = std::chrono::milliseconds(1);
constexpr std::uint16_t kUnknownEvent = 999;

}  // namespace

Device::Device(DeviceConfig config)
    : config_(std::move(config)),
      digits_(digitsOf(config_.rig.bits)),
      camera_(config_.serial,
              {.references = config_.errors, .rig = config_.rig, .seed = config_.seed}),
      drift_(config_.seed, config_.rig.ledDrift, config_.rig.ledStep),
      bootId_(static_cast<std::uint32_t>(mixed(config_.seed, config_.bootCount))) {
    raise(event::kBoot, bootId_, 0);
}

void Device::place(Placement placement) {
    camera_.place(std::move(placement));
    sincePlaced_ = Nanoseconds(0);
}

bool Device::mayLight() const { return interlock::mayLight(interlock_); }

void Device::setInterlock(std::uint8_t bits) {
    const bool could = mayLight();
    interlock_ = bits;
    if (exposing_ && !mayLight()) exposing_->seated = false;
    if (could && !mayLight()) {
        raise(event::kInterlockOpened, bits, exposing_ ? exposing_->number : 0);
        if (current_.led >= 0) {
            abort(status::kInterlock);
            fault_ = status::kInterlock;
        }
    } else if (!could && mayLight()) {
        raise(event::kInterlockClosed, bits, 0);
    }
    tellChange();
}

std::uint64_t Device::clockUs() const {
    return static_cast<std::uint64_t>((now_ - bootedAt_).count() / 1000) + clockUs_;
}

void Device::overheat(bool hot) {
    constexpr std::uint32_t kSensorIndex = 1;
    if (hot == hot_) return;
    hot_ = hot;
    const auto seen = static_cast<std::uint32_t>(temperatures()[kSensorIndex]);
    raise(hot ? event::kOverTemp : event::kTemperatureBack, kSensorIndex, seen);
    if (hot) {
        abort(status::kOverTemp);
        fault_ = status::kOverTemp;
    }
    tellChange();
}

void Device::powerCycle() {
    abort(0);
    startClean();
    frames_ = {};
    notices_ = {};
    statusAt_.reset();
    stats_ = {};
    fault_ = 0;
    nextFrame_ = 1;
    clockUs_ = 0;
    bootedAt_ = now_;
    ++config_.bootCount;
    bootId_ = static_cast<std::uint32_t>(mixed(config_.seed, config_.bootCount));
    raise(event::kBoot, bootId_, 0);
}

void Device::sendUnknownChunk() {
    constexpr auto kUnknown = static_cast<ChunkType>(9);
    const ChunkHeader header{.type = kUnknown,
                             .bootId = bootId_,
                             .captureId = capture_ ? capture_->id : 0,
                             .timeUs = clockUs()};
    frames_.add(encodeChunk(header, std::vector<std::uint8_t>(16)));
}

void Device::tellUnknownEvent() {
    raise(kUnknownEvent, 0, 0);
    tellChange();
}

void Device::pileUpReports(int count) {
    for (int i = 0; i < count; ++i) {
        if (i % 2 == 0) {
            raise(kUnknownEvent, 0, 0);
        } else {
            pushStatus();
        }
    }
}

std::optional<Report> Device::takeInput() { return notices_.take(); }

std::optional<std::vector<std::uint8_t>> Device::takeBulk() { return frames_.take(); }

void Device::flush() {
    frames_.flush();
    if (flushed_) flushed_();
}

// ---- sessions

void Device::claimOrRelease(const SessionSet& set) {
    statusOfLastSet_ = set.release ? release(set) : claim(set);
    if (statusOfLastSet_ == status::kOk) tellChange();
}

std::uint16_t Device::release(const SessionSet& set) {
    if (claim_.owner() == Owner::None || claim_.id() != set.sessionId) return status::kNotOwner;
    abort(0);
    flush();
    raise(event::kEnded, claim_.lowId(), 0);
    claim_ = {};
    return status::kOk;
}

std::uint16_t Device::claim(const SessionSet& set) {
    const auto low = static_cast<std::uint32_t>(set.sessionId);
    if (low == 0 || set.heartbeatMs < 500 || set.heartbeatMs > 10000) return status::kBadArg;
    if (claim_.alive() && claim_.id() != set.sessionId) return status::kBusy;
    if (claim_.id() != set.sessionId) {
        if (claim_.owner() == Owner::Lapsed) raise(event::kEnded, claim_.lowId(), 1);
        startClean();
    }
    claim_.renew(set, now_);
    raise(event::kClaimed, low, 0);
    return status::kOk;
}

void Device::startClean() {
    abort(0);
    flush();
    claim_ = {};
    current_ = {};
    due_.clear();
    format_ = {};
    frames_.forgetFrames();
}

void Device::checkHeartbeat() {
    if (!claim_.alive() || now_ < claim_.lapsesAt()) return;
    lapse(status::kHeartbeat);
    raise(event::kHeartbeatLost,
          static_cast<std::uint32_t>(claim_.silence(now_).count() / 1'000'000),
          claim_.lowId());
    tellChange();
}

/// Control is lost: dark, and what the rig was doing ends. Frame RAM and ACKs stay.
void Device::lapse(std::uint16_t reason) {
    if (claim_.alive()) {
        claim_.lapse();
        ++stats_.lapses;
    }
    abort(reason);
    flush();
}

void Device::linkLost(std::uint32_t cause) {
    lapse(status::kLink);
    raise(event::kLinkLost, cause, 0);
    tellChange();
}

// ---- exposures

void Device::goDark() {
    current_.darken();
    unsettled_ = false;
    for (auto& [frame, settings] : due_) settings.darken();
}

void Device::abort(std::uint16_t reason) {
    // What was acknowledged and waits for its frame holds from now on, the LEDs excepted.
    if (!due_.empty()) current_ = due_.back().second;
    due_.clear();
    goDark();
    if (exposing_ && capture_) {
        const ChunkHeader header{.type = ChunkType::Aborted,
                                 .bootId = bootId_,
                                 .captureId = capture_->id,
                                 .frameIndex = static_cast<std::uint16_t>(capture_->next),
                                 .timeUs = clockUs()};
        frames_.add(encodeChunk(
            header, encode(Aborted{.reason = reason, .frameNumber = exposing_->number})));
    }
    exposing_.reset();
    capture_.reset();
    tellChange();
}

void Device::applyDueSettings() {
    while (!due_.empty() && due_.front().first <= nextFrame_) {
        takeEffect(due_.front().second);
        due_.pop_front();
    }
}

void Device::beginExposureIfDue() {
    if (!capture_ || exposing_ || fault_ != 0) return;
    if (capture_->software && capture_->triggersWaiting == 0) return;
    // Frames that are not wholly sent fill the RAM: the next exposure waits.
    if (frames_.framesWaiting() >= kFrameRam) return;
    applyDueSettings();
    Exposing exposing;
    exposing.flaw = flaw_ ? flaw_() : FrameFlaw::None;
    exposing.pictured = picturedWith(exposing.flaw, current_);
    exposing.settings = exposing.flaw == FrameFlaw::LateSettings ? exposing.pictured : current_;
    exposing.seated = mayLight();
    exposing.clockUs = clockUs_ - static_cast<std::uint64_t>(bootedAt_.count() / 1000);
    before_ = current_;
    exposing.number = nextFrame_++;
    exposing.settling = std::exchange(unsettled_, false) ? kSettling : Nanoseconds(0);
    exposing.start = std::max({now_, earliestStart_, settledAt_});
    exposing.end = exposing.start + grantedExposure(current_.exposureUs);
    exposing_ = exposing;
    earliestStart_ = exposing.start +
                     std::max(link().framePeriod, grantedExposure(current_.exposureUs) + kReadout);
    capture_->triggersWaiting = 0;
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
        for (const auto& [frame, settings] : due_) takeEffect(settings);
        due_.clear();
        tellChange();
    }
}

void Device::runPhotometricClock(const Settings& settings, Nanoseconds time) {
    drift_.run(settings, time);
    sincePlaced_ += time;
}

/// With the output that the LED has halfway through. An exposure that was aborted is not on the
/// photometric clock: when that happens is the host's doing.
Image<std::uint16_t> Device::exposed(const Exposing& done, const NoiseKey& key) {
    const Settings& settings = done.pictured;
    const Nanoseconds exposure = grantedExposure(settings.exposureUs);
    runPhotometricClock(settings, done.settling + exposure / 2);
    const Moment halfway{
        .output = settings.led < 0 ? LedBands::all(1) : drift_.output(settings.led, key.planStep),
        .sincePlaced = sincePlaced_};
    runPhotometricClock(settings, exposure - exposure / 2);
    return camera_.expose(settings, halfway, format_, key);
}

/// What the light and the sensor are really set to.
Settings Device::picturedWith(FrameFlaw flaw, const Settings& settings) const {
    Settings pictured = settings;
    switch (flaw) {
        case FrameFlaw::Unlit: pictured.darken(); break;
        case FrameFlaw::LateSettings:
        case FrameFlaw::HiddenLateSettings: pictured = before_; break;
        case FrameFlaw::OldExposure: pictured.exposureUs = before_.exposureUs; break;
        default: break;
    }
    return pictured;
}

Image<std::uint16_t> Device::flawed(FrameFlaw flaw, Image<std::uint16_t> image) {
    constexpr int kSpot = 8;  // of so many parts of a side
    switch (flaw) {
        case FrameFlaw::PreviousAgain:
            if (picture_.size() == image.size()) return picture_;
            break;
        case FrameFlaw::Black: std::fill(image.pixels().begin(), image.pixels().end(), 0); break;
        case FrameFlaw::Reflex:
            for (int y = 0; y < (image.size().height + kSpot - 1) / kSpot; ++y) {
                for (int x = 0; x < (image.size().width + kSpot - 1) / kSpot; ++x)
                    image.at(x, y) = digits_.fullScale;
            }
            break;
        default: break;
    }
    return image;
}

void Device::tellDrift(const Settings& settings) {
    const auto current = currents(settings.levels);
    for (unsigned c = 0; c < 3; ++c) {
        if (settings.levels[c] == 0) continue;
        raise(event::kLedDrift,
              static_cast<std::uint32_t>(settings.led) << 8 | c,
              current[c] + current[c] / unsigned{kDriftedPart});
    }
}

void Device::queueFrame(const Exposing& done, int index) {
    const NoiseKey key{.seed = config_.seed,
                       .planStep = capture_->id >> 16,
                       .frameIndex = static_cast<std::uint64_t>(index)};
    Image<std::uint16_t> image = flawed(done.flaw, exposed(done, key));
    if (done.flaw == FrameFlaw::LedDrift && done.settings.led >= 0) tellDrift(done.settings);
    const std::vector<std::uint8_t> bytes = packPixels(image, format_.format);
    Trailer trailer = trailerOf(done, image, digits_);
    trailer.frameBytes = static_cast<std::uint32_t>(bytes.size());
    trailer.frameCrc = crc32c(bytes);
    const ChunkHeader header{.bootId = bootId_,
                             .captureId = capture_->id,
                             .frameIndex = static_cast<std::uint16_t>(index),
                             .timeUs = clockUs()};
    const Leader leader = leaderOf(done, format_, image.size(), digits_, temperatures());
    frames_.add({.capture = capture_->id,
                 .index = index,
                 .chunks = frameChunks(header, leader, bytes, trailer, config_.maxChunkPayload)});
    picture_ = std::move(image);
}

// ---- time

Nanoseconds Device::nextEvent() const {
    Nanoseconds next = nextStatusAt_;
    if (exposing_) next = std::min(next, exposing_->end);
    if (claim_.alive()) next = std::min(next, claim_.lapsesAt());
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
