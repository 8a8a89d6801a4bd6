#include "tests/faults/measurement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "driver/rig.h"
#include "sim/in_process.h"

namespace gonio::fault_test {
namespace {

using namespace std::chrono_literals;
using driver::CaptureRequest;
using driver::Rig;

constexpr std::uint64_t kSession = 0x1122334455667788;
constexpr int kBrackets = 3, kExposures = 3, kFrames = 2;
constexpr int kTries = 3;             // of a bracket
constexpr Nanoseconds kLook = 100ms;  // between looks for a lost rig
constexpr Nanoseconds kGiveUp = 2500ms;
constexpr Nanoseconds kDark = 2500ms;  // after loss of control
constexpr Nanoseconds kLongest = 60s;  // of all, whatever happens

CaptureRequest requestOf(int bracket, int exposure) {
    return {.planStep = 1 + static_cast<std::uint64_t>(bracket * kExposures + exposure),
            .led = bracket,
            .levels = LedLevels::only(Band::G, 65535),
            .exposure = Microseconds(320 << exposure),
            .frames = kFrames};
}

/// Passes all on, and measures how long each call goes on past what it was to wait.
class CallWatch : public driver::Transport {
public:
    driver::Transport* watch(driver::Transport* inner) {
        inner_ = inner;
        return this;
    }
    [[nodiscard]] Nanoseconds longest() const { return longest_; }

    [[nodiscard]] driver::DeviceStrings strings() const override { return inner_->strings(); }
    [[nodiscard]] const Clock& clock() const override { return inner_->clock(); }
    Result<void> write(const driver::Report& report) override {
        return timed(0ns, [&] { return inner_->write(report); });
    }
    Result<void> setFeature(const driver::Report& report) override {
        return timed(0ns, [&] { return inner_->setFeature(report); });
    }
    Result<driver::Report> getFeature(std::uint8_t id) override {
        return timed(0ns, [&] { return inner_->getFeature(id); });
    }
    Result<std::optional<driver::Report>> readInput(Nanoseconds wait) override {
        return timed(wait, [&] { return inner_->readInput(wait); });
    }
    Result<std::optional<driver::BulkBytes>> readBulk(Nanoseconds wait) override {
        return timed(wait, [&] { return inner_->readBulk(wait); });
    }
    Result<void> resetStream() override {
        return timed(0ns, [&] { return inner_->resetStream(); });
    }
    Result<void> reopenReports() override {
        return timed(0ns, [&] { return inner_->reopenReports(); });
    }
    Result<void> resetPort() override {
        return timed(0ns, [&] { return inner_->resetPort(); });
    }

private:
    template <class Call>
    auto timed(Nanoseconds wait, Call call) -> decltype(call()) {
        const Nanoseconds begin = clock().now();
        auto done = call();
        longest_ = std::max(longest_, clock().now() - begin - wait);
        return done;
    }
    driver::Transport* inner_ = nullptr;
    Nanoseconds longest_{0};
};

/// What is written to stderr while it lives: the log.
class LogCatcher {
public:
    LogCatcher() { testing::internal::CaptureStderr(); }
    ~LogCatcher() { (void)taken(); }
    LogCatcher(const LogCatcher&) = delete;
    LogCatcher& operator=(const LogCatcher&) = delete;
    std::string taken() {
        if (std::exchange(done_, true)) return {};
        std::string text = testing::internal::GetCapturedStderr();
        fputs(text.c_str(), stderr);
        return text;
    }

private:
    bool done_ = false;
};

/// Looks for a rig that was lost until it is back, or for so long.
class Search {
public:
    /// `calls` may be null.
    Search(RigDoor& door, CallWatch* calls, Outcome& outcome, const SearchLimits& limits)
        : door_(door),
          watch_(calls),
          outcome_(outcome),
          left_(limits.comebacks),
          each_(limits.each) {}

    Result<driver::Transport*> operator()(const Error& lost) {
        outcome_.said += lost.message + "\n";
        outcome_.detected = std::max(outcome_.detected, sinceUnseenPull());
        if (left_-- == 0) return gaveUp("it was lost again and again");
        for (const Nanoseconds end = door_.now() + each_; door_.now() < end;) {
            door_.close();
            door_.pause(kLook);
            door_.with([this](sim::FaultyUsb& usb) { pulls_ = usb.pulls(); });
            auto opened = door_.open();
            if (opened && watch_) return watch_->watch(*opened);
            if (opened) return opened;
            outcome_.said += opened.error().message + "\n";
        }
        return gaveUp("it did not come back");
    }

private:
    static Error gaveUp(const std::string& why) { return {ErrorKind::Interrupted, why}; }
    Nanoseconds sinceUnseenPull() {
        Nanoseconds since{0};
        door_.with([&](sim::FaultyUsb& usb) {
            if (usb.pulls() != pulls_) since = usb.now() - usb.pulledAt();
            pulls_ = usb.pulls();
        });
        return since;
    }
    RigDoor& door_;
    CallWatch* watch_;
    Outcome& outcome_;
    int pulls_ = 0;
    int left_;
    Nanoseconds each_;
};

/// Its pictures; empty: it must be redone, for the rig has rebooted.
Result<std::optional<Pictures>> takeBracket(Rig& rig, int bracket) {
    const std::uint32_t boot = rig.bootId();
    Pictures pictures;
    for (int exposure = 0; exposure < kExposures; ++exposure) {
        const CaptureRequest request = requestOf(bracket, exposure);
        driver::ArmAhead ahead;
        if (exposure + 1 < kExposures) ahead.next = requestOf(bracket, exposure + 1);
        auto capture = rig.capture(request, ahead);
        if (!capture && rig.bootId() != boot) return std::optional<Pictures>{};
        if (!capture) return capture.error();
        for (const Frame& frame : *capture) pictures[request.planStep].push_back(frame.pixels);
    }
    return std::optional(std::move(pictures));
}

Result<void> takeAll(Rig& rig, Outcome& outcome) {
    for (int bracket = 0; bracket < kBrackets; ++bracket) {
        std::optional<Pictures> taken;
        for (int tries = 0; !taken; ++tries) {
            auto done = takeBracket(rig, bracket);
            if (!done) return done.error();
            taken = std::move(*done);
            if (!taken && tries == kTries) return Error{ErrorKind::Device, "reboots all the time"};
            if (!taken) ++outcome.counts["bracketsRedone"];
        }
        outcome.pictures.merge(*taken);
    }
    return rig.darken();
}

void count(const driver::Anomalies& seen, const driver::LinkCounters& link, Outcome& outcome) {
    const auto add = [&](const char* name, std::uint32_t value) {
        outcome.counts[name] += static_cast<int>(value);
    };
    add("emptyTransfers", seen.emptyTransfers);
    add("badLengths", seen.badLengths);
    add("badHeaders", seen.badHeaders);
    add("badPayloads", seen.badPayloads);
    add("badFrames", seen.badFrames);
    add("lostChunks", seen.lostChunks);
    add("disordered", seen.disordered);
    add("duplicates", seen.duplicates);
    add("stale", seen.stale);
    add("unknownTypes", seen.unknownTypes);
    add("contradictions", seen.contradictions);
    add("aborted", seen.aborted);
    add("badReports", link.badReports);
    add("unknownReports", link.unknownReports);
    add("foreignAcks", link.foreignAcks);
    add("repeats", link.repeats);
    add("lostStatuses", link.lostStatuses);
    add("statusesUnexplained", link.lostStatuses);
    add("missedEvents", link.missedEvents);
}

/// Of the rig itself. What it had done before the script began is taken off.
void addStats(sim::FaultyUsb& usb, int sign, Outcome& outcome) {
    const driver::Stats& stats = usb.device().stats();
    const auto& overflow = usb.device().overflow();
    outcome.counts["reportsOverflowed"] += sign * overflow.reports;
    // Less those that did not reach the driver.
    outcome.counts["statusesUnexplained"] -=
        sign * (overflow.statuses + usb.reports().statusesLost());
    outcome.counts["portResets"] += sign * usb.portResets();
    outcome.counts["haltsCleared"] += sign * usb.reports().haltsCleared();
    outcome.counts["framesMade"] += sign * static_cast<int>(stats.framesMade);
    outcome.counts["chunksResent"] += sign * static_cast<int>(stats.resends);
    outcome.counts["replays"] += sign * static_cast<int>(stats.replays);
}

bool asks(const Row& row, const std::string& counter) {
    return std::any_of(row.counts.begin(), row.counts.end(), [&](const WantedCount& count) {
        return count.name == counter;
    });
}

/// Of the script. What other scripts had done before is taken off.
void addFaults(const sim::FaultTally& tally, int sign, Outcome& outcome) {
    for (std::size_t i = 0; i < sim::kFaultKinds; ++i) {
        const auto kind = static_cast<sim::FaultKind>(i);
        outcome.counts["did " + std::string(sim::faultName(kind))] += sign * tally.of(kind);
    }
}

void judgeError(const Error& error, Outcome& outcome) {
    outcome.said += error.message;
    outcome.counts["deviceStatus"] = error.deviceStatus;
    outcome.verdict = error.kind == ErrorKind::Interrupted ? "interrupted" : "fault";
}

/// The measurement on a rig that could be opened.
void run(RigDoor& door,
         CallWatch& calls,
         const RigSetup& setup,
         const Row& row,
         Rig& rig,
         Outcome& outcome) {
    constexpr int kMostComebacks = 60;
    outcome.counts["bracketsRedone"] = outcome.counts["deviceStatus"] = 0;
    rig.onLost(Search(door, &calls, outcome, {.comebacks = kMostComebacks, .each = kGiveUp}));
    Result<void> done = rig.configure(setup.window);
    if (done) done = takeAll(rig, outcome);
    outcome.verdict = "completed";
    if (!done) judgeError(done.error(), outcome);
    // The last of those that were lost is known only when another one has come.
    if (done && asks(row, "statusesUnexplained")) (void)rig.link().freshStatus();
    // What the last chunk lay in is in flight again when another one is asked for.
    if (done && asks(row, "inFlight")) (void)rig.link().readBulk(0ns);
    rig.onLost({});
    readBack(rig, door, outcome);
    (void)rig.close();
}

bool isLit(RigDoor& door) {
    bool lit = false;
    door.with([&](sim::FaultyUsb& usb) { lit = usb.device().lit(); });
    return lit;
}

/// In time: nobody controls the rig any more.
bool goesDark(RigDoor& door) {
    for (const Nanoseconds end = door.now() + kDark; isLit(door) && door.now() < end;)
        door.pause(kLook);
    return !isLit(door);
}

}  // namespace

driver::Comeback comebackThrough(RigDoor& door, Outcome& outcome, const SearchLimits& limits) {
    return Search(door, nullptr, outcome, limits);
}

void beginScript(RigDoor& door, const sim::FaultScript& script, Outcome& outcome) {
    door.with([&](sim::FaultyUsb& usb) {
        addStats(usb, -1, outcome);
        addFaults(usb.tally(), -1, outcome);
        usb.play(script);
        outcome.malformed = usb.malformed();
    });
}

void noteInterruptions(Rig& rig, Outcome& outcome) {
    for (const driver::Interruption& gap : rig.takeInterruptions()) {
        ++outcome.counts["interruptions"];
        outcome.counts["resent"] += gap.resent;
        outcome.counts["redone"] += gap.redone;
        outcome.counts["otherBoots"] += gap.sameBoot ? 0 : 1;
    }
}

void readBack(Rig& rig, RigDoor& door, Outcome& outcome) {
    outcome.counts["eventGaps"] += 0;
    for (const char* name : {"interruptions", "resent", "redone", "otherBoots"})
        outcome.counts[name] += 0;
    const auto events = rig.link().takeEvents();
    if (events) {
        for (const driver::Event& event : *events) outcome.events.push_back(event.code);
        outcome.counts["events"] = static_cast<int>(events->size());
        for (std::size_t i = 1; i < events->size(); ++i) {
            if ((*events)[i].sequence != (*events)[i - 1].sequence + 1)
                ++outcome.counts["eventGaps"];
        }
    } else if (outcome.verdict == "completed") {
        outcome.troubles.push_back("events: " + events.error().message);
    }
    noteInterruptions(rig, outcome);
    // Their numbers begin anew with each boot, and are one after the other else.
    if (outcome.counts["eventGaps"] != outcome.counts["otherBoots"])
        outcome.troubles.emplace_back("an event was missed, or told twice");
    outcome.counts["reopens"] += static_cast<int>(rig.link().reopens());
    count(rig.anomalies(), rig.link().counters(), outcome);
    const RigDoor::Ring ring = door.ring();
    outcome.counts["ring"] = ring.allowed;
    outcome.counts["inFlight"] = ring.inFlight;
    outcome.counts["steps"] = static_cast<int>(outcome.pictures.size());
    door.with([&](sim::FaultyUsb& usb) {
        addStats(usb, 1, outcome);
        outcome.reclaimed = usb.reclaimed();
        outcome.noticed = usb.reports().noticed();
        addFaults(usb.tally(), 1, outcome);
    });
}

Outcome measure(RigDoor& door, const RigSetup& setup, const Row& row) {
    Outcome outcome;
    outcome.slack = door.slack();
    LogCatcher log;
    CallWatch calls;
    beginScript(door, row.script, outcome);
    const Nanoseconds begin = door.now();
    const auto transport = door.open();
    if (transport) {
        if (auto rig = Rig::open(*calls.watch(*transport), kSession)) {
            run(door, calls, setup, row, *rig, outcome);
        } else {
            outcome.verdict = "refused";
            outcome.said += rig.error().message;
        }
    } else {
        outcome.verdict = "refused";
        outcome.said += transport.error().message;
    }
    door.close();
    outcome.longestCall = calls.longest();
    outcome.said += log.taken();
    if (door.now() - begin > kLongest) outcome.troubles.emplace_back("it took too long");
    if (!goesDark(door)) outcome.troubles.emplace_back("an LED is still lit");
    return outcome;
}

const Pictures& undisturbed(const RigSetup& setup) {
    static std::map<int, Pictures> known;
    Pictures& pictures = known[setup.window.size.width];
    if (pictures.empty()) {
        const auto door = inProcess(setup);
        pictures = measure(*door, setup, Row{}).pictures;
    }
    return pictures;
}

}  // namespace gonio::fault_test
