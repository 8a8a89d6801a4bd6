// The commands of PROTOCOL.md 2, one function each.

#include <algorithm>

#include "driver/protocol/pixels.h"
#include "sim/device.h"
#include "sim/light.h"
#include "sim/random.h"

namespace gonio::sim {

using namespace driver;  // the wire's words

namespace {

constexpr std::uint16_t kRetryMs = 20;  // of what waits for the stream to be read

}  // namespace

void Device::output(const Report& report) {
    const Result<Command> command = decodeCommand(report);
    if (!command) {
        ++stats_.crcRejects;
        return;
    }
    notices_.answer(execute(*command));
}

Ack Device::execute(const Command& command) {
    if (claim_.owns(command)) claim_.feed(now_);
    if (const auto answer = claim_.answerOf(command)) {
        if (answer->replayed) ++stats_.replays;
        return answer->ack;
    }
    Ack ack = carryOut(command);
    if (command.op == Op::Reboot) return ack;  // it has forgotten who asked
    if (ack.status != status::kOk) ack.result = {};
    if (ack.status == status::kBusy) {  // nothing was done: the same command comes again
        ack.retryMs = kRetryMs;
        return ack;
    }
    ++stats_.commandsDone;
    claim_.keep(command, ack);
    return ack;
}

Ack Device::carryOut(const Command& command) {
    Ack ack{.sequence = command.sequence, .op = command.op, .sessionLow = command.sessionLow};
    const Arguments& arguments = command.arguments;
    switch (command.op) {
        case Op::Ping: ack.result = encodeU64(clockUs()); break;
        case Op::SetLed: ack.status = setLed(decodeSetLed(arguments), ack.result); break;
        case Op::SetExposure:
            ack.status = setExposure(decodeSetExposure(arguments), ack.result);
            break;
        case Op::SetFormat: ack.status = setFormat(decodeSetFormat(arguments), ack.result); break;
        case Op::Arm: ack.status = arm(decodeArm(arguments), ack.result); break;
        case Op::Trigger: ack.status = trigger(decodeU64(arguments), ack.result); break;
        case Op::Abort: abort(0); break;
        case Op::Resend: ack.status = resend(decodeResend(arguments)); break;
        case Op::Flush:
            flush();
            ack.result = encodeU32(frames_.nextSequence());
            break;
        case Op::SyncTime: ack.result = encodeU64(clockUs()); break;
        case Op::ClearFault: ack.status = clearFault(); break;
        case Op::Reboot:
            abort(0);
            rebootWanted_ = true;
            break;
        default: ack.status = status::kUnsupported; break;
    }
    return ack;
}

std::uint16_t Device::clearFault() {
    if (fault_ == status::kInterlock && !mayLight()) return fault_;
    if (fault_ == status::kOverTemp && hot_) return fault_;
    fault_ = 0;
    return status::kOk;
}

/// What the settings will be when all that waits is in effect.
Settings Device::settingsToCome() const { return due_.empty() ? current_ : due_.back().second; }

std::uint32_t Device::applySettings(const Settings& wanted) {
    if (exposing_ && freeRunning()) {
        const std::uint32_t effective = exposing_->number + kControlLatency;
        due_.emplace_back(effective, wanted);
        return effective;
    }
    takeEffect(wanted);
    return nextFrame_;
}

void Device::takeEffect(const Settings& wanted) {
    const bool lit = wanted.led >= 0;
    if (lit && (wanted.led != current_.led || wanted.levels != current_.levels)) {
        settledAt_ = now_ + kSettling;
        unsettled_ = true;
    }
    unsettled_ = unsettled_ && lit;
    current_ = wanted;
}

std::uint16_t Device::setLed(const SetLed& args, Arguments& result) {
    if (args.led >= config_.leds) return status::kBadArg;
    const bool dark = args.levels == std::array<std::uint16_t, 3>{};
    if (!dark) {
        if (fault_ != 0) return fault_;
        if (!mayLight()) return status::kInterlock;
    }
    Settings wanted = settingsToCome();
    wanted.led = dark ? -1 : args.led;
    wanted.levels = args.levels;
    result = encodeU32(applySettings(wanted));
    tellChange();
    return status::kOk;
}

std::uint16_t Device::setExposure(const SetExposure& args, Arguments& result) {
    if (args.exposureUs < kExposureMinUs || args.exposureUs > kExposureMaxUs || args.gain != 0) {
        return status::kBadArg;
    }
    Settings wanted = settingsToCome();
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
    const bool binning = (args.binning == 1 || args.binning == 2 || args.binning == 4) &&
                         (config_.binnings & args.binning) != 0;
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
    if (args.captureId == 0 || frames_.holds(args.captureId) || args.frames == 0 ||
        args.frames > kMaxFrames || args.trigger > 1) {
        return status::kBadArg;
    }
    capture_ = Capture{.id = args.captureId, .frames = args.frames, .software = args.trigger == 1};
    result = encodeU32(nextFrame_);
    earliestStart_ = std::max(earliestStart_, now_);
    beginExposureIfDue();
    tellChange();
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
    const FrameQueue::Resent done = frames_.resend(args);
    stats_.resends += done.chunks;
    if (done.status == status::kFrameGone) ++stats_.framesGone;
    return done.status;
}

}  // namespace gonio::sim
