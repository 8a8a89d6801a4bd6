#include "daemon/doctor_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/clock_drift.h"
#include "daemon/dark_pair.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

constexpr double kTooSlow = 0.05;                // s, a round trip: a dead stream takes 30 of them
constexpr double kNearLimit = 2;                 // K
constexpr double kNoisy = 1.3, kTooQuiet = 0.7;  // of the profile's noise
constexpr double kBlackTolerance = 1;            // DN
constexpr double kUsualShare = 1e-3;             // of reports and chunks that come damaged

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

Finding clock(const Result<ClockDrift>& drift) {
    if (!drift) {
        return {"clock",
                Verdict::Fail,
                drift.error().message,
                "plug the rig in again; bring its firmware up to date"};
    }
    const std::string seen = "round trip " + milliseconds(drift->roundTrip) + ", drift " +
                             ppm(drift->relative) + " +- " + ppm(drift->uncertainty) + " in " +
                             fixed(drift->passed, 2) + " s";
    if (drift->beyondCrystals()) {
        return {"clock",
                Verdict::Warn,
                seen,
                "exposures are counted by this clock: have the rig's oscillator looked at"};
    }
    if (drift->roundTrip > kSlowRoundTrip) {
        return {"clock", Verdict::Warn, seen, "plug it in without a hub; is the computer busy?"};
    }
    if (drift->uncertainty > kMostCrystalsDiffer) {
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

/// Why none is taken; empty: they are.
std::string noFrames(const Result<driver::Status>& status, const Result<ClockLook>& look) {
    if (status && !driver::interlock::mayLight(status->interlock))
        return "no frame is valid while the interlock is open";
    if (look && look->usual > kTooSlow)
        return "not taken: a command takes " + milliseconds(look->usual);
    return "";
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

Finding noise(const Result<driver::Capture>& dark, const RigProfile& profile) {
    if (!dark) return {"noise", Verdict::Note, "no frame to judge", ""};
    const Frame& frame = dark->front();
    const DarkNoise seen = noiseOf(*dark);
    const double wanted = expectedSigma(profile.noise, frame);
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
    const auto clockBefore = lookAtClock(wire);
    const auto status = rig.status();
    const std::string inTheWay = noFrames(status, clockBefore);
    const Result<driver::Capture> dark =
        inTheWay.empty() ? takeDarkPair(rig) : Error{ErrorKind::Device, inTheWay};
    const auto after = rig.status();
    const bool opened = after && !driver::interlock::mayLight(after->interlock);
    const Result<ClockDrift> drift =
        clockBefore ? driftSince(*clockBefore, wire) : clockBefore.error();
    const auto stats = wire.stats();
    std::vector<Finding> findings{identity(rig.identify()), clock(drift)};
    if (status) {
        findings.push_back(temperature(*status, wire.limits()));
        findings.push_back(interlock(*status));
    } else {
        const std::string& why = status.error().message;
        findings.push_back({"temperature", Verdict::Fail, why, "plug the rig in again"});
        findings.push_back({"interlock", Verdict::Note, "not known", ""});
    }
    findings.push_back(inTheWay.empty() ? selfTest(dark, opened)
                                        : Finding{"self-test", Verdict::Note, inTheWay, ""});
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
