#include "daemon/doctor_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/finest_binning.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

constexpr int kReadings = 32;  // of the clock
constexpr double kApart = 1;   // s, between two looks at it
constexpr auto kPause = std::chrono::milliseconds(100);
constexpr double kTick = 1e-6;                   // s, of the rig's clock
constexpr double kMostDrift = 200e-6;            // two usual crystals differ by 100 ppm at most
constexpr double kSlowRoundTrip = 0.02;          // s; a command is repeated after 0.1 s
constexpr double kNearLimit = 2;                 // K
constexpr Microseconds kExposure{1000};          // of a dark frame: its dark current is nothing
constexpr double kNoisy = 1.3, kTooQuiet = 0.7;  // of the profile's noise
constexpr double kOutlier = 5;                   // sigma: hot pixels have a noise of their own
constexpr double kBlackTolerance = 1;            // DN
constexpr double kUsualShare = 1e-3;             // of reports and chunks that come damaged
constexpr std::uint64_t kOwnStep = (std::uint64_t{1} << 48) - 1;  // jobs count theirs from 1

std::string ppm(double relative) { return fixed(relative * 1e6, 0) + " ppm"; }
std::string milliseconds(double seconds) { return fixed(seconds * 1e3, 2) + " ms"; }

// ---- who it is ----

Finding identity(const driver::RigInfo& info) {
    const driver::Ident& ident = info.ident;
    const auto part = [&](int shift) { return std::to_string(ident.firmware >> shift & 0xff); };
    return {"identity",
            Verdict::Ok,
            info.serial + ", firmware " + part(16) + "." + part(8) + "." + part(0) +
                ", hardware revision " + std::to_string(ident.hardwareRevision) + "; " +
                std::to_string(info.ledAngles.size()) + " LEDs, sensor " +
                std::to_string(info.sensor.width) + " x " + std::to_string(info.sensor.height) +
                " of " + std::to_string(info.bitDepth) + " bits",
            ""};
}

// ---- clock ----

/// The rig's clock beside the host's, s: means of readings, and what their scatter leaves open.
struct ClockReading {
    double host = 0, offset = 0, uncertainty = 0, roundTrip = 0;
};

/// Of those whose answer came quickly; a delay that all have cancels between two calls.
Result<ClockReading> readClock(driver::RigLink& link) {
    const auto now = [&] { return std::chrono::duration<double>(link.clock().now()).count(); };
    std::vector<ClockReading> readings;
    for (int i = 0; i < kReadings; ++i) {
        const double before = now();
        const auto answer = link.command(
            driver::Op::SyncTime, driver::encodeU64(static_cast<std::uint64_t>(before * 1e6)));
        if (!answer) return answer.error();
        const double host = (before + now()) / 2;
        readings.push_back({.host = host,
                            .offset = static_cast<double>(driver::decodeU64(*answer)) * 1e-6 - host,
                            .roundTrip = now() - before});
    }
    const auto quickest =
        std::min_element(readings.begin(), readings.end(), [](const auto& a, const auto& b) {
            return a.roundTrip < b.roundTrip;
        });
    const double most = 2 * quickest->roundTrip;
    double n = 0;
    ClockReading mean{.roundTrip = quickest->roundTrip};
    std::erase_if(readings, [&](const ClockReading& one) { return one.roundTrip > most; });
    for (const ClockReading& one : readings) {
        n += 1;
        mean.host += (one.host - mean.host) / n;
        mean.offset += (one.offset - mean.offset) / n;
    }
    double squares = 0;
    for (const ClockReading& one : readings) squares += std::pow(one.offset - mean.offset, 2);
    mean.uncertainty = std::sqrt(squares / std::max(n - 1, 1.0) / n) + kTick;
    return mean;
}

/// A second after the first, or later.
Result<ClockReading> readClockAgain(driver::RigLink& link, const ClockReading& first) {
    const auto then = std::chrono::duration<double>(first.host + kApart);
    while (link.clock().now() < then) {
        if (auto waited = link.readBulk(kPause); !waited) return waited.error();
    }
    return readClock(link);
}

Finding clock(const Result<ClockReading>& first, const Result<ClockReading>& last) {
    if (!first || !last) {
        return {"clock",
                Verdict::Fail,
                (first ? last : first).error().message,
                "plug the rig in again; bring its firmware up to date"};
    }
    const double passed = last->host - first->host;
    const double drift = (last->offset - first->offset) / passed;
    const double uncertainty = 2 * std::hypot(first->uncertainty, last->uncertainty) / passed;
    const std::string seen = "round trip " + milliseconds(last->roundTrip) + ", drift " +
                             ppm(drift) + " +- " + ppm(uncertainty) + " in " + fixed(passed, 2) +
                             " s";
    if (std::abs(drift) - uncertainty > kMostDrift) {
        return {"clock",
                Verdict::Warn,
                seen,
                "exposures are counted by this clock: have the rig's oscillator looked at"};
    }
    if (last->roundTrip > kSlowRoundTrip) {
        return {"clock", Verdict::Warn, seen, "plug it in without a hub; is the computer busy?"};
    }
    if (uncertainty > kMostDrift) {
        return {"clock",
                Verdict::Note,
                seen + ": not enough to judge by",
                "once more, with fewer programs at once"};
    }
    return {"clock", Verdict::Ok, seen, ""};
}

// ---- what STATUS says ----

Finding temperature(const driver::Status& status, const driver::Limits& limits) {
    struct Place {
        const char* name;
        std::optional<double> celsius;
        std::array<std::int16_t, 2> range;
    };
    const std::array places{
        Place{"LED board", driver::celsius(status.temperature[0]), limits.ledTemperature},
        Place{"sensor", driver::celsius(status.temperature[1]), limits.sensorTemperature}};
    std::string seen;
    Verdict verdict = Verdict::Ok;
    for (const Place& place : places) {
        seen += (seen.empty() ? "" : ", ") + std::string(place.name) + " ";
        if (!place.celsius) {
            seen += "without a thermometer";
            continue;
        }
        const double low = place.range[0] * 0.01, high = place.range[1] * 0.01;
        seen += fixed(*place.celsius, 1) + " degC of " + fixed(low, 0) + ".." + fixed(high, 0);
        const double room = std::min(*place.celsius - low, high - *place.celsius);
        if (room < kNearLimit)
            verdict = std::max(verdict, room < 0 ? Verdict::Fail : Verdict::Warn);
    }
    return {
        "temperature",
        verdict,
        seen,
        verdict == Verdict::Ok ? "" : "outside no frame is valid: air, shade, or time to warm up"};
}

Finding interlock(const driver::Status& status) {
    if (status.state == driver::RigState::Fault) {
        return {"interlock",
                Verdict::Fail,
                "the rig is in fault: " + driver::statusName(status.fault),
                "remove the cause; the next job clears the fault"};
    }
    if (driver::interlock::mayLight(status.interlock))
        return {"interlock", Verdict::Ok, "closed", ""};
    const bool seated = (status.interlock & driver::interlock::kSeated) != 0;
    return {"interlock",
            Verdict::Warn,
            seated ? "the cover is open" : "the aperture does not sit on the sample",
            "no LED is lit like this: set the rig down on the sample, close the cover"};
}

// ---- frames ----

Result<driver::Capture> darkFrames(driver::Rig& rig) {
    const driver::RigInfo info = rig.identify();
    const auto shortest = std::max(kExposure, info.exposureMin);
    const Window whole{.size = info.sensor, .binning = finestBinning(info.limits)};
    if (auto done = rig.configure(whole); !done) return done.error();
    return rig.capture({.planStep = kOwnStep, .exposure = shortest, .frames = 2, .keepLit = false});
}

Finding selfTest(const Result<driver::Capture>& dark, bool opened) {
    if (!dark) {
        const Error& why = dark.error();
        if (opened || why.deviceStatus == driver::status::kInterlock)
            return {"self-test", Verdict::Warn, why.message, "set the rig down, close the cover"};
        if (why.deviceStatus == driver::status::kOverTemp)
            return {"self-test", Verdict::Warn, why.message, "too warm to light: let it cool"};
        return {"self-test",
                Verdict::Fail,
                why.message,
                why.deviceStatus != 0 ? "unplug the rig and plug it in; then the rig's firmware"
                                      : "another cable and port first; then the rig's firmware"};
    }
    const Size size = dark->front().pixels.size();
    const std::string seen = "2 dark frames of " + std::to_string(size.width) + " x " +
                             std::to_string(size.height) + ", both checksums agree, valid";
    if (dark->anomalies.total() == 0 && dark->resends == 0)
        return {"self-test", Verdict::Ok, seen, ""};
    return {"self-test",
            Verdict::Warn,
            seen + ", after " + dark->anomalies.text(),
            "another cable or port: the stream comes damaged, and is repaired each time"};
}

/// Of one frame, in DN: from the difference of two, which leaves out what both have.
struct DarkNoise {
    double mean = 0, sigma = 0;
    double step = 0;  ///< from the second to the first
};

DarkNoise noiseOf(const Frame& a, const Frame& b) {
    const auto first = a.pixels.pixels();
    const auto second = b.pixels.pixels();
    DarkNoise noise;
    double most = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < 2; ++pass) {
        double n = 0, sum = 0, level = 0, squares = 0;
        for (std::size_t i = 0; i < first.size(); ++i) {
            const double difference = double{1} * first[i] - second[i];
            if (std::abs(difference - noise.step) > most) continue;
            n += 1;
            sum += difference;
            squares += difference * difference;
            level += (double{1} * first[i] + second[i]) / 2;
        }
        const double mean = sum / n;
        const double spread = std::sqrt(std::max(squares / n - mean * mean, 0.0));
        noise = {.mean = level / n, .sigma = spread / std::sqrt(2.0), .step = mean};
        most = kOutlier * std::max(spread, 1.0);
    }
    return noise;
}

Finding noise(const Result<driver::Capture>& dark, const RigProfile& profile) {
    if (!dark) return {"noise", Verdict::Note, "no frame to judge", ""};
    const Frame& frame = dark->front();
    const DarkNoise seen = noiseOf(frame, (*dark)[1]);
    // A binned pixel is the mean of its members; it is rounded once.
    const double electronsPerDn = profile.noise.electronsPerDn;
    const double rounding = electronsPerDn * electronsPerDn / 12;
    const double analogue = profile.noise.darkVariance(frame.exposure.seconds()) - rounding;
    const int members = frame.window.binning * frame.window.binning;
    const double wanted = std::sqrt(analogue / members + rounding) / electronsPerDn;
    const std::string text = fixed(seen.sigma, 2) + " DN, " + profile.name + " says " +
                             fixed(wanted, 2) + "; black " + fixed(seen.mean, 1) +
                             " DN, the rig says " + std::to_string(frame.blackLevel) + ", " +
                             fixed(std::abs(seen.step), 1) + " DN from frame to frame";
    const auto near = [](double a, double b) { return std::abs(a - b) <= kBlackTolerance; };
    if (!near(seen.mean, frame.blackLevel) || !near(seen.step, 0)) {  // what is no number is not
        return {"noise",
                Verdict::Warn,
                text,
                "does light leak in? set the rig down, close the cover; then gonio calibrate dark"};
    }
    if (seen.sigma > kNoisy * wanted || seen.sigma < kTooQuiet * wanted) {
        return {"noise",
                Verdict::Warn,
                text,
                "is it the right profile? then gonio calibrate sensor measures it anew"};
    }
    return {"noise", Verdict::Ok, text, ""};
}

// ---- counters ----

Finding counters(const Result<driver::Stats>& stats) {
    if (!stats) return {"counters", Verdict::Fail, stats.error().message, "plug the rig in again"};
    const auto share = [](std::uint32_t part, std::uint32_t of) {
        return static_cast<double>(part) / std::max(static_cast<double>(of), 1.0);
    };
    const auto count = [](std::uint32_t n, const char* what) {
        return std::to_string(n) + " " + what;
    };
    const std::string seen = "in " + std::to_string(stats->uptimeS) +
                             " s since it was started: " + count(stats->framesMade, "frames, ") +
                             count(stats->resends, "chunks sent again, ") +
                             count(stats->framesGone, "asked for too late, ") +
                             count(stats->fifoOverruns, "frames skipped, ") +
                             count(stats->crcRejects, "reports damaged, ") +
                             count(stats->replays, "commands repeated, ") +
                             count(stats->lapses, "heartbeats lost");
    if (stats->fifoOverruns > 0) {
        return {"counters",
                Verdict::Warn,
                seen,
                "the host was too slow to take frames: fewer programs at once, a port of its own"};
    }
    // A frame has some ten chunks.
    if (share(stats->resends, stats->framesMade) > 10 * kUsualShare ||
        share(stats->crcRejects, stats->commandsDone) > kUsualShare) {
        return {"counters", Verdict::Warn, seen, "another cable or port: bytes come damaged"};
    }
    return {"counters", Verdict::Ok, seen, ""};
}

/// What the host has seen go wrong since it claimed the rig.
Finding link(driver::Rig& rig) {
    if (const auto& lost = rig.link().lost()) {
        return {
            "link", Verdict::Fail, lost->message, "plug it in again; then another cable or port"};
    }
    const driver::LinkCounters& seen = rig.link().counters();
    std::string text;
    const auto add = [&](std::uint32_t n, const char* what) {
        if (n > 0) text += (text.empty() ? "" : ", ") + std::to_string(n) + " " + what;
    };
    add(seen.badReports, "reports came damaged");
    add(seen.repeats, "commands repeated");
    add(seen.lostStatuses, "reports of the state lost");
    add(seen.foreignAcks, "answers to another program");
    add(rig.link().reopens(), "times the reports fell silent and were opened anew");
    if (rig.anomalies().total() > 0)
        text += (text.empty() ? "" : ", ") + ("in the stream " + rig.anomalies().text());
    if (!text.empty()) text = "all made good: " + text;
    if (seen.missedEvents > 0) {
        text += (text.empty() ? "" : "; ") + std::to_string(seen.missedEvents) +
                " events were gone before they were read";
    }
    if (text.empty()) return {"link", Verdict::Ok, "nothing lost since it was claimed", ""};
    return {"link",
            Verdict::Note,
            "since it was claimed, " + text,
            "where it was not unplugged meanwhile: another cable or port"};
}

}  // namespace

std::vector<Finding> examineClaimed(driver::Rig& rig, const RigProfile& profile) {
    driver::RigLink& wire = rig.link();
    const auto clockBefore = readClock(wire);
    const auto status = rig.status();
    const bool open = status && !driver::interlock::mayLight(status->interlock);
    const Result<driver::Capture> dark =
        open ? Error{ErrorKind::Device, "the interlock is open"} : darkFrames(rig);
    const auto after = rig.status();
    const bool opened = after && !driver::interlock::mayLight(after->interlock);
    const auto clockAfter = clockBefore ? readClockAgain(wire, *clockBefore) : clockBefore;
    const auto stats = wire.stats();
    std::vector<Finding> findings{identity(rig.identify()), clock(clockBefore, clockAfter)};
    if (status) {
        findings.push_back(temperature(*status, wire.limits()));
        findings.push_back(interlock(*status));
    } else {
        const std::string& why = status.error().message;
        findings.push_back({"temperature", Verdict::Fail, why, "plug the rig in again"});
        findings.push_back({"interlock", Verdict::Note, "not known", ""});
    }
    findings.push_back(open ? Finding{"self-test",
                                      Verdict::Note,
                                      "no frame is valid while the interlock is open",
                                      ""}
                            : selfTest(dark, opened));
    findings.push_back(noise(dark, profile));
    findings.push_back(counters(stats));
    findings.push_back(link(rig));
    return findings;
}

std::vector<Finding> examineUnasked(const driver::RigInfo& info,
                                    const std::optional<driver::Status>& status,
                                    const std::string& why) {
    const auto unasked = [&](const char* subject) {
        return Finding{subject, Verdict::Note, "not looked at: " + why, ""};
    };
    return {identity(info),
            unasked("clock"),
            status ? temperature(*status, info.limits) : unasked("temperature"),
            status ? interlock(*status) : unasked("interlock"),
            unasked("self-test"),
            unasked("noise"),
            unasked("counters"),
            unasked("link")};
}

std::vector<Finding> examineInside(driver::Transport& transport,
                                   std::uint64_t session,
                                   const RigProfile& profile) {
    auto rig = driver::Rig::open(transport, session);
    if (!rig) return {{"claim", Verdict::Fail, rig.error().message, "end who uses it; see holder"}};
    std::vector<Finding> findings{{"claim", Verdict::Ok, "claimed, and given back dark", ""}};
    for (Finding& one : examineClaimed(*rig, profile)) findings.push_back(std::move(one));
    if (Result<void> given = rig->close(); !given)
        findings.front() = {"claim", Verdict::Warn, given.error().message, "plug it in again"};
    return findings;
}

}  // namespace gonio::daemon
