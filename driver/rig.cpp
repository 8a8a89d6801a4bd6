#include "driver/rig.h"

#include <algorithm>

#include "driver/protocol/pixels.h"

namespace gonio::driver {
namespace {

constexpr int kResends = 2;
constexpr int kRecaptures = 3;
constexpr Nanoseconds kPoll = std::chrono::milliseconds(100);
constexpr Nanoseconds kResendWait = std::chrono::milliseconds(500);

std::uint32_t largestFrame(const Ident& ident) {
    return 2U * ident.sensorWidth * ident.sensorHeight;
}

std::optional<double> celsius(std::int16_t hundredths) {
    if (hundredths == kNoTemperature) return std::nullopt;
    return hundredths / 100.0;
}

}  // namespace

Rig::Rig(RigLink link, Assembler assembler)
    : link_(std::make_unique<RigLink>(std::move(link))), assembler_(std::move(assembler)) {}

Result<Rig> Rig::open(Transport& transport, std::uint64_t sessionId) {
    Result<RigLink> link = RigLink::open(transport, sessionId);
    if (!link) return link.error();
    const Ident ident = link->ident();
    return Rig(std::move(*link),
               Assembler(ident.bootId, ident.maxChunkPayload, largestFrame(ident)));
}

Rig::~Rig() {
    if (link_) (void)close();
}

Result<void> Rig::close() {
    if (!link_) return {};
    const Result<void> released = link_->release();
    link_.reset();
    return released;
}

RigInfo Rig::identify() const {
    const Ident& ident = link_->ident();
    const Limits& limits = link_->limits();
    RigInfo info;
    info.serial = link_->transport().strings().serial;
    for (std::size_t i = 0; i < ident.ledCount; ++i) {
        info.ledAngles.push_back(Radians::fromDegrees(ident.ledAngle[i] / 100.0));
    }
    info.sensor = {ident.sensorWidth, ident.sensorHeight};
    info.bitDepth = ident.bitDepth;
    info.blackLevel = limits.blackLevel;
    info.fullScale = limits.fullScale;
    info.exposureMin = Microseconds(ident.exposureMinUs);
    info.exposureMax = Microseconds(ident.exposureMaxUs);
    info.framePeriod = Microseconds(limits.framePeriodUs);
    info.maxFrames = limits.maxFrames;
    return info;
}

Result<void> Rig::configure(const Window& window, PixelFormat format) {
    const auto u16 = [](int v) { return static_cast<std::uint16_t>(v); };
    const auto result =
        link_->command(Op::SetFormat,
                       encode(SetFormat{.format = format,
                                        .x = u16(window.x),
                                        .y = u16(window.y),
                                        .width = u16(window.size.width),
                                        .height = u16(window.size.height),
                                        .binning = static_cast<std::uint8_t>(window.binning)}));
    if (!result) return result.error().in("configure");
    window_ = window;
    format_ = format;
    return {};
}

Result<void> Rig::darken() {
    const auto result = link_->command(Op::SetLed, encode(SetLed{}));
    if (!result) return result.error().in("darken");
    return {};
}

Result<Rig::Settings> Rig::apply(const CaptureRequest& request) {
    Settings settings{.led = request.led, .levels = request.levels, .exposure = {}};
    if (request.levels.dark()) settings.led.reset();
    const SetLed led{.led = static_cast<std::uint8_t>(settings.led.value_or(0)),
                     .levels = request.levels.value};
    const auto lit = link_->command(Op::SetLed, encode(led));
    if (!lit) return lit.error().in("LED " + std::to_string(led.led));
    const auto exposed = link_->command(
        Op::SetExposure,
        encode(SetExposure{.exposureUs = static_cast<std::uint32_t>(request.exposure.count())}));
    if (!exposed) {
        return exposed.error().in("exposure " + std::to_string(request.exposure.count()) + " us");
    }
    const Granted granted = decodeGranted(*exposed);
    settings.exposure = {.requested = request.exposure,
                         .granted = Nanoseconds(static_cast<std::int64_t>(granted.exposureNs))};
    settings.effectiveFrame = std::max(decodeU32(*lit), granted.effectiveFrame);
    return settings;
}

Result<std::vector<Frame>> Rig::capture(const CaptureRequest& request) {
    if (request.frames < 1) {
        return Error{ErrorKind::Usage,
                     "capture: " + std::to_string(request.frames) + " frames, wanted 1 or more"};
    }
    std::optional<Error> last;
    for (int attemptNumber = 0; attemptNumber <= kRecaptures; ++attemptNumber) {
        if (attemptNumber > 0) ++assembler_.anomalies().recaptures;
        Result<std::vector<Frame>> frames = attempt(request, attemptNumber);
        if (frames) return frames;
        last = frames.error();
        // A refusal by the rig is final; silence and bad frames are worth another
        // try.
        if (last->deviceStatus != 0) break;
        (void)link_->command(Op::Abort);
    }
    const Anomalies& a = anomalies();
    (void)darken();
    return Error{ErrorKind::Device,
                 "capture " + std::to_string(request.planStep) + ": " + last->message +
                     " (seen: " + std::to_string(a.badChunks) + " bad chunks, " +
                     std::to_string(a.sequenceGaps) + " lost, " + std::to_string(a.badFrames) +
                     " bad frames, " + std::to_string(a.resends) + " resends)",
                 last->deviceStatus};
}

Result<std::vector<Frame>> Rig::attempt(const CaptureRequest& request, int attemptNumber) {
    Result<Settings> settings = apply(request);
    if (!settings) return settings.error();
    const std::uint64_t captureId =
        request.planStep << 16 | static_cast<std::uint64_t>(attemptNumber + 1);
    assembler_.expect(captureId);
    // Settings may reach the sensor some frames late: so many more are taken, and
    // dropped.
    const int late = link_->ident().controlLatency;
    const auto first = link_->command(
        Op::Arm,
        encode(Arm{.captureId = captureId, .frames = static_cast<std::uint16_t>(request.frames)}));
    if (!first) return first.error().in("arm");
    const std::uint32_t firstFrame = decodeU32(*first);
    if (settings->effectiveFrame > firstFrame + static_cast<std::uint32_t>(late)) {
        return Error{ErrorKind::Device, "settings take effect too late"};
    }
    const Nanoseconds patience = settings->exposure.granted +
                                 2 * Nanoseconds(Microseconds(link_->limits().framePeriodUs)) +
                                 std::chrono::milliseconds(500 + link_->ident().ledSettleMs);
    std::vector<Frame> frames;
    for (int index = 0; index < request.frames; ++index) {
        Result<std::optional<RawFrame>> raw = awaitFrame(index, captureId, patience);
        if (!raw) return raw.error();
        if (!*raw)
            return Error{ErrorKind::Device, "frame " + std::to_string(index) + " is overdue"};
        if (auto why = objection(**raw, *settings)) {
            return Error{ErrorKind::Device, "frame " + std::to_string(index) + ": " + *why};
        }
        frames.push_back(toFrame(std::move(**raw), captureId));
    }
    return frames;
}

Result<std::optional<RawFrame>> Rig::awaitFrame(int index,
                                                std::uint64_t captureId,
                                                Nanoseconds patience) {
    const Clock& clock = link_->transport().clock();
    Nanoseconds deadline = clock.now() + patience;
    int resends = 0;
    while (true) {
        if (Result<void> alive = link_->keepAlive(); !alive) return alive.error();
        auto transfer =
            link_->transport().readBulk(std::clamp(deadline - clock.now(), Nanoseconds(0), kPoll));
        if (!transfer) return transfer.error();
        if (*transfer) {
            auto frame = assembler_.add(**transfer);
            if (frame && frame->index == index) return frame;
            if (assembler_.aborted()) {
                const std::uint16_t reason = assembler_.aborted()->reason;
                return Error{ErrorKind::Device,
                             "the rig aborted the exposure: " + statusName(reason),
                             reason};
            }
            if (!frame) continue;
            // A later frame is complete: this one has lost chunks. (It is taken again
            // as a whole.)
        }
        const bool late = clock.now() >= deadline || *transfer;
        if (!late) continue;
        const auto missing = assembler_.missing(index);
        if (resends == kResends) return std::optional<RawFrame>();
        ++resends;
        ++assembler_.anomalies().resends;
        const Resend resend{.captureId = captureId,
                            .frame = static_cast<std::uint16_t>(index),
                            .firstChunk = missing ? missing->first : std::uint16_t{0},
                            .lastChunk = missing ? missing->last : std::uint16_t{0xFFFF}};
        const auto asked = link_->command(Op::Resend, encode(resend));
        if (!asked && asked.error().deviceStatus == status::kFrameGone)
            return std::optional<RawFrame>();
        if (!asked) return asked.error();
        deadline = clock.now() + kResendWait;
    }
}

std::optional<std::string> Rig::objection(const RawFrame& raw, const Settings& settings) const {
    const Leader& l = raw.leader;
    const Size sent = window_.sent();
    if (l.width != sent.width || l.height != sent.height || l.x != window_.x || l.y != window_.y ||
        l.binning != window_.binning || l.format != format_ ||
        l.stride != strideOf(format_, sent.width)) {
        return "another window or format than configured";
    }
    if (l.frameNumber < settings.effectiveFrame) return "taken before the settings took effect";
    const std::uint8_t led = settings.led ? static_cast<std::uint8_t>(*settings.led) : kDarkLed;
    if (l.led != led || l.ledLevel != settings.levels.value)
        return "another LED or level than planned";
    if (static_cast<std::int64_t>(l.exposureGrantedNs) != settings.exposure.granted.count()) {
        return "another exposure than granted";
    }
    // Dark frames may be taken with the interlock open.
    const std::uint16_t wanted =
        settings.led ? validity::kAll : validity::kCurrent | validity::kTemperature;
    if ((raw.trailer.validity & wanted) != wanted) {
        return "not valid (bits " + std::to_string(raw.trailer.validity) +
               ": 1 interlock, 2 current, 4 temperature)";
    }
    return std::nullopt;
}

Frame Rig::toFrame(RawFrame raw, std::uint64_t captureId) const {
    const Leader& l = raw.leader;
    Frame frame;
    frame.pixels = unpackPixels(raw.pixels, {l.width, l.height}, l.format);
    frame.captureId = captureId;
    frame.index = raw.index;
    frame.number = l.frameNumber;
    if (l.led != kDarkLed) frame.led = l.led;
    frame.levels.value = l.ledLevel;
    frame.exposure = {.requested = Microseconds(l.exposureRequestedUs),
                      .granted = Nanoseconds(static_cast<std::int64_t>(l.exposureGrantedNs))};
    frame.gainDb = l.gain / 100.0;
    frame.window = window_;
    frame.bitDepth = l.bitDepth;
    frame.blackLevel = l.blackLevel;
    for (std::size_t i = 0; i < 4; ++i) frame.celsius[i] = celsius(l.temperature[i]);
    for (std::size_t c = 0; c < 3; ++c) {
        frame.currentMinMilliamp[c] = raw.trailer.currentMin[c] / 10.0;
        frame.currentMaxMilliamp[c] = raw.trailer.currentMax[c] / 10.0;
    }
    frame.saturatedPixels = raw.trailer.saturatedPixels;
    frame.start = Microseconds(static_cast<std::int64_t>(l.exposureStartUs));
    return frame;
}

}  // namespace gonio::driver
