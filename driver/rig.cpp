#include "driver/rig.h"

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace gonio::driver {
namespace {

using namespace std::chrono_literals;

constexpr int kRecaptures = 3;  // per capture; PROTOCOL.md 3, "Repair"
constexpr int kCaptureIds = 8;  // ids tried in a row when frame RAM still holds the first
constexpr std::uint64_t kMaxPlanStep = (std::uint64_t{1} << 48) - 1;

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

Result<Rig> Rig::open(Transport& transport, std::uint64_t sessionId) {
    return open(transport, LinkOptions{.sessionId = sessionId});
}

Result<Rig> Rig::open(Transport& transport, const LinkOptions& options) {
    auto link = RigLink::open(transport, options);
    if (!link) return link.error();
    Rig rig(std::move(*link));
    rig.boot_ = rig.bootId();
    if (auto started = rig.start(); !started) return started.error();
    return rig;
}

/// A claim taken up again finds whatever its last host left behind.
Result<void> Rig::start() {
    if (!link_->resumed()) return {};
    return abort();
}

Rig::~Rig() { (void)close(); }

Result<void> Rig::close() {
    if (!link_) return {};
    // A rig that does not hear this may still hear the release, which darkens too.
    (void)putOut();
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
    beginCall();
    const Geometry geometry{.window = window, .format = format, .frameBytes = *wanted};
    const auto set = surviving([&]() -> Result<void> {
        if (ahead_) {
            if (auto idle = abort(); !idle) return idle;
        }
        return setFormat(geometry);
    });
    if (!set) return set.error().in(what);
    geometry_ = geometry;
    rebooted_.reset();
    return {};
}

/// The rig must count as many bytes per frame.
Result<void> Rig::setFormat(const Geometry& geometry) {
    const Window& window = geometry.window;
    const auto granted =
        link_->command(Op::SetFormat,
                       encode(SetFormat{.format = geometry.format,
                                        .x = static_cast<std::uint16_t>(window.x),
                                        .y = static_cast<std::uint16_t>(window.y),
                                        .width = static_cast<std::uint16_t>(window.size.width),
                                        .height = static_cast<std::uint16_t>(window.size.height),
                                        .binning = static_cast<std::uint8_t>(window.binning)}));
    if (!granted) return granted.error();
    const std::uint32_t bytes = decodeU32(*granted);
    if (bytes == geometry.frameBytes) return {};
    return Error{ErrorKind::Device,
                 "the rig says " + std::to_string(bytes) + " bytes per frame, this window has " +
                     std::to_string(geometry.frameBytes)};
}

Result<void> Rig::darken() {
    beginCall();
    return surviving([&] { return putOut(); });
}

Result<void> Rig::putOut() {
    if (ahead_) {
        if (auto idle = abort(); !idle) return idle.error().in("darken");
    }
    const auto dark = link_->command(Op::SetLed, encode(SetLed{}));
    if (!dark) return dark.error().in("darken");
    return {};
}

Result<void> Rig::keepAlive() {
    beginCall();
    return surviving([&] { return link_->keepAlive(); });
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

Result<void> Rig::check(const ArmAhead& ahead) const {
    if (!ahead.next) return {};
    const Result<void> sound = check(*ahead.next);
    if (!sound) return sound.error().in("armed ahead, " + describe(*ahead.next));
    return {};
}

/// Leaves nothing armed but `request`, and that only when all is well.
Result<void> Rig::admit(const CaptureRequest& request, const ArmAhead& ahead) {
    Result<void> sound = check(request);
    if (sound) sound = check(ahead);
    if (!ahead_ || (sound && ahead_->request == request)) return sound;
    const Result<void> idle = abort();
    return sound ? idle : sound;
}

Result<Capture> Rig::capture(const CaptureRequest& request,
                             const ArmAhead& ahead,
                             const FrameSink& sink) {
    beginCall();
    const auto admitted = inOneBoot([&] { return admit(request, ahead); });
    if (!admitted) return admitted.error().in(describe(request));
    const Anomalies before = anomalies();
    const bool toSink = static_cast<bool>(sink);
    provideMemory(request, ahead, toSink);
    progress_.start(request.frames, toSink ? framesHeld() : 0);
    Result<void> done = fill({.request = request, .ahead = ahead, .sink = sink});
    if (done && !request.keepLit) done = inOneBoot([&] { return putOut(); });
    if (!done) {
        (void)abort();  // what cannot be reached any more goes dark by its own heartbeat
        const Error error = failed(done.error(), before).in(describe(request));
        progress_.start(0, 0);  // lets go of the frames that are there
        return error;
    }
    return Capture{.frames = progress_.takeFrames(),
                   .anomalies = anomalies().since(before),
                   .discarded = progress_.discarded,
                   .resends = progress_.resends,
                   .recaptures = progress_.recaptures,
                   .evidence = progress_.evidence()};
}

/// The error with its evidence.
Error Rig::failed(const Error& error, const Anomalies& before) const {
    std::string message = error.message + " (" + plural(progress_.resends, "resend") + ", " +
                          plural(progress_.recaptures, "recapture") +
                          "; anomalies: " + anomalies().since(before).text();
    if (!progress_.evidence().empty()) message += "; " + progress_.evidence();
    return {error.kind, message + ")", error.deviceStatus};
}

/// Attempts until every frame is there. Early frames cost no recapture, but a rig whose settings
/// are still not in effect after control_latency attempts does not do what it says.
Result<void> Rig::fill(const Making& making) {
    int early = 0;
    while (true) {
        if (auto tried = attempt(making); !tried) return tried;
        if (progress_.toArm() == 0) return {};
        if (progress_.failed()) {
            if (progress_.recaptures == kRecaptures)
                return Error{ErrorKind::Device, "frames are missing or not as planned"};
            ++progress_.recaptures;
        } else if (!progress_.interrupted()) {  // else it is the link's doing
            if (++early > link_->ident().controlLatency)
                return Error{ErrorKind::Device, "settings do not take effect"};
        }
        if (auto quiet = inOneBoot([&] { return quiesce(); }); !quiet) return quiet;
    }
}

Result<void> Rig::attempt(const Making& making) {
    progress_.begin();
    const auto armed = inOneBoot([&] { return takeUpOrArm(making.request, progress_.toArm()); });
    if (!armed) return armed.error();
    bool again = false;
    return inOneBoot([&]() -> Result<void> {
        if (std::exchange(again, true)) {
            if (auto asked = askForHeld(*armed); !asked) return asked;
        }
        return collect(*armed, making);
    });
}

Result<void> Rig::collect(const ArmedCapture& armed, const Making& making) {
    const auto exposed = [&]() -> Result<void> {
        return mayArmAhead(making) ? armAhead(*making.ahead.next) : Result<void>();
    };
    // A sink may keep the rig alive, which may be lost and come back in it.
    bool cameBack = false;
    const auto arrived = [&]() -> Result<void> {
        if (!making.sink) return {};
        const int before = comebacks_;
        auto given = progress_.deliver(making.sink, pixels_);
        cameBack = given && comebacks_ != before;
        return cameBack ? Error{ErrorKind::Interrupted, "the rig came back"} : given;
    };
    Collector collector(*link_, assembler_, pixels_);
    while (true) {
        cameBack = false;
        auto done =  // by reference: a function of its own would allocate amid frames
            collector.collect(armed, progress_, exposed, std::ref(arrived));
        if (!cameBack) return done;
        if (!link_->lost()) {
            if (auto told = tellReboot()) return *told;
        }
        if (auto asked = askForHeld(armed); !asked) return asked;
    }
}

/// What was armed ahead is this request, or admit() would have aborted it; a later attempt finds
/// nothing armed, or quiesce() would have.
Result<ArmedCapture> Rig::takeUpOrArm(const CaptureRequest& request, int frames) {
    if (const std::optional<OnItsWay> ready = std::exchange(ahead_, std::nullopt)) {
        assembler_.moveOn();
        return ready->armed;
    }
    return arm(request, frames, Turn::Present);
}

/// A status says that the rig refused, and did nothing: then its own capture will hear it again.
/// Without one nobody knows what the rig does.
Result<void> Rig::armAhead(const CaptureRequest& request) {
    const Result<ArmedCapture> armed = arm(request, request.frames, Turn::Next);
    if (!armed) {
        assembler_.forgetNext();
        if (armed.error().deviceStatus != 0) return {};
        return armed.error().in("armed ahead, " + describe(request));
    }
    ahead_ = {.request = request, .armed = *armed};
    return {};
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
/// its plan step): the next attempt's is free. The frames are expected before they are asked for.
Result<ArmedCapture> Rig::arm(const CaptureRequest& request, int frames, Turn turn) {
    const Result<FramePlan> plan = apply(request);
    if (!plan) return plan.error();
    ArmedCapture armed{.expected = sized(frames), .plan = *plan};
    for (int tries = 1;; ++tries) {
        armed.expected.captureId = ids_.next(request.planStep);
        const Result<void> expected = turn == Turn::Present ? assembler_.expect(armed.expected)
                                                            : assembler_.expectNext(armed.expected);
        if (!expected) return expected.error();
        const auto first = link_->command(Op::Arm,
                                          encode(Arm{.captureId = armed.expected.captureId,
                                                     .frames = static_cast<std::uint16_t>(frames),
                                                     .trigger = 0}));
        if (first) return armed;
        if (first.error().deviceStatus != status::kBadArg || tries == kCaptureIds)
            return first.error();
    }
}

/// Idle, with nothing on its way: not of the last attempt, nor of what was armed ahead.
Result<void> Rig::quiesce() {
    ahead_.reset();
    assembler_.forgetNext();
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

/// Dark and idle at once, with nothing on its way.
Result<void> Rig::abort() {
    ahead_.reset();
    assembler_.forgetNext();
    if (auto idle = link_->command(Op::Abort); !idle) return idle.error();
    return flush();
}

Result<void> Rig::flush() {
    const auto next = link_->command(Op::Flush);
    if (!next) return next.error();
    assembler_.flushed(decodeU32(*next));
    return {};
}

}  // namespace gonio::driver
