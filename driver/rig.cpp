#include "driver/rig.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

namespace gonio::driver {
namespace {

using namespace std::chrono_literals;

constexpr int kResends = 2;     // per frame; PROTOCOL.md 3, "Repair"
constexpr int kRecaptures = 3;  // likewise
constexpr int kCaptureIds = 8;  // ids tried in a row when frame RAM still holds the first
constexpr std::uint32_t kCanResend = 1U << 2;  // capability bit
constexpr std::uint64_t kMaxPlanStep = (std::uint64_t{1} << 48) - 1;
constexpr std::size_t kReasonsKept = 8;

Error usage(const std::string& what) { return {ErrorKind::Usage, what}; }

std::string plural(int n, const std::string& noun) {
    return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

std::string describe(const CaptureRequest& request) {
    const bool dark = request.levels.dark() || !request.led;
    return "capture step " + std::to_string(request.planStep) + " (" +
           (dark ? std::string("dark") : "LED " + std::to_string(*request.led)) + ", " +
           std::to_string(request.exposure.count()) + " us, " + plural(request.frames, "frame") +
           ")";
}

bool fits16(int value) { return value >= 0 && value <= std::numeric_limits<std::uint16_t>::max(); }

}  // namespace

struct Rig::Progress {
    std::vector<std::optional<Frame>> frames;
    std::vector<int> asked;      ///< RESENDs of this attempt, by frame
    std::vector<bool> hopeless;  ///< of this attempt, by frame
    bool failed = false;         ///< this attempt lost or refused a frame
    int discarded = 0, resends = 0, recaptures = 0;
    std::vector<std::string> reasons;

    explicit Progress(int n) : frames(static_cast<std::size_t>(n)) {}

    void begin() {
        asked.assign(frames.size(), 0);
        hopeless.assign(frames.size(), false);
        failed = false;
    }
    /// Wanted, and still to be hoped for in this attempt.
    [[nodiscard]] bool waitsFor(int frame) const {
        const auto i = static_cast<std::size_t>(frame);
        return !frames[i] && !hopeless[i];
    }
    [[nodiscard]] bool waits() const {
        for (int i = 0; i < static_cast<int>(frames.size()); ++i) {
            if (waitsFor(i)) return true;
        }
        return false;
    }
    /// Frames up to the last one that is missing: those must be armed again.
    [[nodiscard]] int toArm() const {
        const auto last = std::find(frames.rbegin(), frames.rend(), std::nullopt);
        return static_cast<int>(frames.rend() - last);
    }
    void giveUp(int frame, const std::string& why) {
        hopeless[static_cast<std::size_t>(frame)] = true;
        failed = true;
        if (reasons.size() < kReasonsKept)
            reasons.push_back("frame " + std::to_string(frame) + ": " + why);
    }
    [[nodiscard]] std::string evidence() const {
        std::string list;
        for (const std::string& reason : reasons) list += (list.empty() ? "" : "; ") + reason;
        return list;
    }
};

Result<Rig> Rig::open(Transport& transport, std::uint64_t sessionId) {
    return open(transport, LinkOptions{.sessionId = sessionId});
}

Result<Rig> Rig::open(Transport& transport, const LinkOptions& options) {
    auto link = RigLink::open(transport, options);
    if (!link) return link.error();
    Rig rig(std::move(*link));
    if (auto started = rig.start(); !started) return started.error();
    return rig;
}

/// A claim taken up again finds whatever its last host left behind.
Result<void> Rig::start() {
    if (!link_->resumed()) return {};
    if (auto idle = link_->command(Op::Abort); !idle) return idle.error();
    return flush();
}

Rig::~Rig() { (void)close(); }

Result<void> Rig::close() {
    if (!link_) return {};
    (void)darken();  // a rig that does not hear this may still hear the release, which darkens too
    geometry_.reset();
    return link_->release();
}

RigInfo Rig::identify() const {
    const Ident& ident = link_->ident();
    const Limits& limits = link_->limits();
    RigInfo info{.serial = link_->strings().serial,
                 .ledAngles = {},
                 .sensor = {ident.sensorWidth, ident.sensorHeight},
                 .bitDepth = ident.bitDepth,
                 .blackLevel = limits.blackLevel,
                 .fullScale = limits.fullScale,
                 .exposureMin = Microseconds(ident.exposureMinUs),
                 .exposureMax = Microseconds(ident.exposureMaxUs),
                 .framePeriod = Microseconds(limits.framePeriodUs),
                 .maxFrames = limits.maxFrames,
                 .ident = ident,
                 .limits = limits};
    for (std::size_t i = 0; i < ident.ledCount; ++i)
        info.ledAngles.push_back(Radians::fromDegrees(ident.ledAngle[i] * 0.01));
    return info;
}

Result<void> Rig::configure(const Window& window, PixelFormat format) {
    const Size size = window.size;
    const std::string what = "configure " + std::to_string(size.width) + "x" +
                             std::to_string(size.height) + " at " + std::to_string(window.x) + "," +
                             std::to_string(window.y) + ", binning " +
                             std::to_string(window.binning);
    const auto wanted = frameBytes(window, format);
    const bool sendable = fits16(window.x) && fits16(window.y) && fits16(size.width) &&
                          fits16(size.height) && window.binning <= 255;
    if (!wanted || !sendable) return usage(what + ": not a window of any sensor");
    geometry_.reset();
    const auto granted =
        link_->command(Op::SetFormat,
                       encode(SetFormat{.format = format,
                                        .x = static_cast<std::uint16_t>(window.x),
                                        .y = static_cast<std::uint16_t>(window.y),
                                        .width = static_cast<std::uint16_t>(size.width),
                                        .height = static_cast<std::uint16_t>(size.height),
                                        .binning = static_cast<std::uint8_t>(window.binning)}));
    if (!granted) return granted.error().in(what);
    const std::uint32_t bytes = decodeU32(*granted);
    if (bytes != *wanted) {
        return Error{ErrorKind::Device,
                     what + ": the rig says " + std::to_string(bytes) +
                         " bytes per frame, this window has " + std::to_string(*wanted)};
    }
    geometry_ = Geometry{.window = window, .format = format, .frameBytes = bytes};
    return {};
}

Result<void> Rig::darken() {
    const auto dark = link_->command(Op::SetLed, encode(SetLed{}));
    if (!dark) return dark.error().in("darken");
    return {};
}

Result<void> Rig::check(const CaptureRequest& request) const {
    const Ident& ident = link_->ident();
    const Limits& limits = link_->limits();
    if (!geometry_) return usage("not configured: call configure() first");
    if (request.planStep > kMaxPlanStep) return usage("plan step needs more than 48 bits");
    if (request.frames < 1 || request.frames > limits.maxFrames) {
        return usage(plural(request.frames, "frame") + ", wanted 1.." +
                     std::to_string(limits.maxFrames));
    }
    if (!request.led && !request.levels.dark()) return usage("levels without an LED");
    if (request.led && (*request.led < 0 || *request.led >= ident.ledCount)) {
        return usage("LED " + std::to_string(*request.led) + ", the rig has 0.." +
                     std::to_string(ident.ledCount - 1));
    }
    if (request.exposure.count() < ident.exposureMinUs ||
        request.exposure.count() > ident.exposureMaxUs) {
        return usage(std::to_string(request.exposure.count()) + " us, the rig exposes for " +
                     std::to_string(ident.exposureMinUs) + ".." +
                     std::to_string(ident.exposureMaxUs) + " us");
    }
    if (!(request.gainDb >= 0 && request.gainDb <= limits.gainMax * 0.01)) {
        return usage("gain " + std::to_string(request.gainDb) + " dB, the rig has 0.." +
                     std::to_string(limits.gainMax * 0.01));
    }
    return {};
}

Result<Capture> Rig::capture(const CaptureRequest& request) {
    const std::string what = describe(request);
    if (auto sound = check(request); !sound) return sound.error().in(what);
    const Anomalies before = anomalies();
    Progress progress(request.frames);
    Result<void> done = fill(request, progress);
    if (done && !request.keepLit) done = darken();
    if (!done) {
        makeSafe();
        const Error& error = done.error();
        std::string message = what + ": " + error.message + " (" +
                              plural(progress.resends, "resend") + ", " +
                              plural(progress.recaptures, "recapture") +
                              "; anomalies: " + anomalies().since(before).text();
        if (!progress.reasons.empty()) message += "; " + progress.evidence();
        return Error{error.kind, message + ")", error.deviceStatus};
    }
    Capture capture{.frames = {},
                    .anomalies = anomalies().since(before),
                    .discarded = progress.discarded,
                    .resends = progress.resends,
                    .recaptures = progress.recaptures};
    for (auto& frame : progress.frames) capture.frames.push_back(std::move(*frame));
    return capture;
}

/// Attempts until every frame is there. Early frames cost no recapture, but a rig whose settings
/// are still not in effect after control_latency attempts does not do what it says.
Result<void> Rig::fill(const CaptureRequest& request, Progress& progress) {
    int early = 0;
    while (true) {
        if (auto tried = attempt(request, progress); !tried) return tried;
        if (progress.toArm() == 0) return {};
        if (!progress.failed) {
            if (++early > link_->ident().controlLatency)
                return Error{ErrorKind::Device, "settings do not take effect"};
        } else if (progress.recaptures == kRecaptures) {
            return Error{ErrorKind::Device, "frames are missing or not as planned"};
        } else {
            ++progress.recaptures;
        }
        if (auto quiet = quiesce(); !quiet) return quiet;
    }
}

Result<void> Rig::attempt(const CaptureRequest& request, Progress& progress) {
    progress.begin();
    const Result<FramePlan> plan = apply(request);
    if (!plan) return plan.error();
    if (auto armed = arm(request.planStep, progress.toArm()); !armed) return armed;
    return collect(*plan, progress);
}

Result<FramePlan> Rig::apply(const CaptureRequest& request) {
    const bool dark = request.levels.dark();
    const SetLed led{.led = static_cast<std::uint8_t>(dark ? 0 : *request.led),
                     .levels = request.levels.value};
    const auto lit = link_->command(Op::SetLed, encode(led));
    if (!lit) return lit.error();
    const SetExposure exposure{
        .exposureUs = static_cast<std::uint32_t>(request.exposure.count()),
        .gain = static_cast<std::uint16_t>(std::lround(request.gainDb * 100))};
    const auto exposed = link_->command(Op::SetExposure, encode(exposure));
    if (!exposed) return exposed.error();
    const Granted granted = decodeGranted(*exposed);
    // Deadlines come from it: no quantisation of any sensor is coarser than this.
    const Nanoseconds most = 2 * Nanoseconds(request.exposure) + Nanoseconds(100ms);
    if (granted.exposureNs == 0 || granted.exposureNs > static_cast<std::uint64_t>(most.count())) {
        return Error{ErrorKind::Device,
                     "SET_EXPOSURE: " + std::to_string(granted.exposureNs) + " ns granted for " +
                         std::to_string(exposure.exposureUs) + " us"};
    }
    // The later of the two, frame numbers wrapping.
    const std::uint32_t ledFrame = decodeU32(*lit);
    const bool ledLast = static_cast<std::int32_t>(ledFrame - granted.effectiveFrame) > 0;
    return FramePlan{
        .window = geometry_->window,
        .format = geometry_->format,
        .led = dark ? std::nullopt : request.led,
        .levels = request.levels,
        .exposure = {.requested = request.exposure,
                     .granted = Nanoseconds(static_cast<std::int64_t>(granted.exposureNs))},
        .gain = granted.gain,
        .effectiveFrame = ledLast ? ledFrame : granted.effectiveFrame,
        .bitDepth = link_->ident().bitDepth};
}

/// A capture_id that frame RAM still holds is refused with BAD_ARG (a host that came back repeats
/// its plan step): the next attempt's is free.
Result<void> Rig::arm(std::uint64_t planStep, int frames) {
    if (planStep != lastStep_) lastAttempt_ = 0;
    lastStep_ = planStep;
    Result<void> armed;
    for (int tries = 0; tries < kCaptureIds; ++tries) {
        // From 1, so that no capture_id is 0; 65535 attempts at one step wrap.
        lastAttempt_ = static_cast<std::uint16_t>(lastAttempt_ == 0xFFFF ? 1 : lastAttempt_ + 1);
        const ExpectedCapture expected{.bootId = link_->ident().bootId,
                                       .captureId = planStep << 16 | lastAttempt_,
                                       .frames = frames,
                                       .frameBytes = geometry_->frameBytes,
                                       .maxChunkPayload = link_->ident().maxChunkPayload};
        if (auto sized = assembler_.expect(expected); !sized) return sized;
        const auto first = link_->command(Op::Arm,
                                          encode(Arm{.captureId = expected.captureId,
                                                     .frames = static_cast<std::uint16_t>(frames),
                                                     .trigger = 0}));
        if (first) return {};
        armed = first.error();
        if (armed.error().deviceStatus != status::kBadArg) break;
    }
    return armed;
}

/// PROTOCOL.md 2: a frame is overdue after settling, exposure, two frame periods and 500 ms. Every
/// new chunk starts the wait anew; there are finitely many of them.
Nanoseconds Rig::patience(const Exposure& exposure) const {
    return exposure.granted + 2 * Nanoseconds(Microseconds(link_->limits().framePeriodUs)) +
           Nanoseconds(std::chrono::milliseconds(link_->ident().ledSettleMs)) + 500ms;
}

Result<void> Rig::collect(const FramePlan& plan, Progress& progress) {
    const Nanoseconds wait = patience(plan.exposure);
    Nanoseconds deadline = link_->clock().now() + wait;
    while (progress.waits()) {
        const Nanoseconds left = std::max(Nanoseconds{0}, deadline - link_->clock().now());
        const auto transfer = link_->readBulk(left);
        if (!transfer) return transfer.error();
        if (*transfer && assembler_.feed(**transfer)) deadline = link_->clock().now() + wait;
        while (const auto wire = assembler_.take()) accept(*wire, plan, progress);
        if (const auto& aborted = assembler_.aborted()) {
            return Error{ErrorKind::Device,
                         "the rig aborted frame number " + std::to_string(aborted->frameNumber) +
                             ": " + statusName(aborted->reason),
                         aborted->reason};
        }
        std::vector<MissingChunks> again = assembler_.lost();
        if (link_->clock().now() >= deadline) {
            again.clear();
            for (int i = 0; i < static_cast<int>(progress.frames.size()); ++i) {
                if (const auto chunks = assembler_.missing(i)) again.push_back(*chunks);
            }
            deadline = link_->clock().now() + wait;
        }
        for (const MissingChunks& chunks : again) {
            if (!progress.waitsFor(chunks.frame)) continue;
            if (auto asked = askAgain(chunks, progress); !asked) return asked;
        }
    }
    return {};
}

void Rig::accept(const WireFrame& wire, const FramePlan& plan, Progress& progress) {
    if (!progress.waitsFor(wire.index)) return;
    auto verdict = judge(wire, plan);
    if (auto* frame = std::get_if<Frame>(&verdict)) {
        progress.frames[static_cast<std::size_t>(wire.index)] = std::move(*frame);
    } else if (const auto* rejected = std::get_if<Rejected>(&verdict)) {
        progress.giveUp(wire.index, rejected->why);
    } else {
        progress.hopeless[static_cast<std::size_t>(wire.index)] = true;
        ++progress.discarded;
    }
}

Result<void> Rig::askAgain(const MissingChunks& chunks, Progress& progress) {
    int& asked = progress.asked[static_cast<std::size_t>(chunks.frame)];
    const std::string range =
        "chunks " + std::to_string(chunks.first) + ".." + std::to_string(chunks.last) + " missing";
    if ((link_->ident().capabilities & kCanResend) == 0) {
        progress.giveUp(chunks.frame, range + ", the rig cannot resend");
        return {};
    }
    if (asked == kResends) {
        progress.giveUp(chunks.frame, range + " after " + plural(asked, "RESEND"));
        return {};
    }
    ++asked;
    ++progress.resends;
    const auto sent =
        link_->command(Op::Resend,
                       encode(Resend{.captureId = lastStep_ << 16 | lastAttempt_,
                                     .frame = static_cast<std::uint16_t>(chunks.frame),
                                     .firstChunk = chunks.first,
                                     .lastChunk = chunks.last}));
    if (sent) {
        assembler_.askedFor(chunks);
        return {};
    }
    const int code = sent.error().deviceStatus;
    if (code != status::kFrameGone && code != status::kBadRange) return sent.error();
    progress.giveUp(chunks.frame, range + ", " + statusName(static_cast<std::uint16_t>(code)));
    return {};
}

/// Idle, with nothing of the last attempt on its way.
Result<void> Rig::quiesce() {
    const Result<Status> now = link_->freshStatus();
    if (!now) return now.error();
    if (now->state == RigState::Fault) {
        return Error{
            ErrorKind::Device, "the rig is in fault: " + statusName(now->fault), now->fault};
    }
    if (now->state != RigState::Idle) {
        if (auto idle = link_->command(Op::Abort); !idle) return idle.error();
    }
    return flush();
}

Result<void> Rig::flush() {
    const auto next = link_->command(Op::Flush);
    if (!next) return next.error();
    assembler_.flushed(decodeU32(*next));
    return {};
}

/// ABORT is dark at once. What cannot be reached any more goes dark by its own heartbeat.
void Rig::makeSafe() {
    if (link_->command(Op::Abort)) (void)flush();
}

}  // namespace gonio::driver
