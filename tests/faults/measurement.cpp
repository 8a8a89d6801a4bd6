#include "tests/faults/measurement.h"

#include <optional>

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

/// Looks for a rig that was lost until it is back, or for so long.
class Search {
public:
    Search(RigDoor& door, Outcome& outcome, int mostComebacks)
        : door_(door), outcome_(outcome), left_(mostComebacks) {}

    Result<driver::Transport*> operator()(const Error& lost) {
        outcome_.said += lost.message + "\n";
        outcome_.detected = std::max(outcome_.detected, sinceUnseenPull());
        if (left_-- == 0) return gaveUp("it was lost again and again");
        for (const Nanoseconds end = door_.now() + kGiveUp; door_.now() < end;) {
            door_.close();
            door_.pause(kLook);
            door_.with([this](sim::FaultyUsb& usb) { pulls_ = usb.pulls(); });
            auto opened = door_.open();
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
    Outcome& outcome_;
    int pulls_ = 0;
    int left_;
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
    add("missedEvents", link.missedEvents);
}

/// Of the rig itself. What it had done before the script began is taken off.
void addStats(const driver::Stats& stats, int sign, Outcome& outcome) {
    outcome.counts["framesMade"] += sign * static_cast<int>(stats.framesMade);
    outcome.counts["chunksResent"] += sign * static_cast<int>(stats.resends);
    outcome.counts["replays"] += sign * static_cast<int>(stats.replays);
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
void run(RigDoor& door, const RigSetup& setup, Rig& rig, Outcome& outcome) {
    constexpr int kMostComebacks = 60;
    rig.onLost(comebackThrough(door, outcome, kMostComebacks));
    Result<void> done = rig.configure(setup.window);
    if (done) done = takeAll(rig, outcome);
    outcome.verdict = "completed";
    if (!done) judgeError(done.error(), outcome);
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

driver::Comeback comebackThrough(RigDoor& door, Outcome& outcome, int most) {
    return Search(door, outcome, most);
}

void beginScript(RigDoor& door, const sim::FaultScript& script, Outcome& outcome) {
    door.with([&](sim::FaultyUsb& usb) {
        addStats(usb.device().stats(), -1, outcome);
        addFaults(usb.tally(), -1, outcome);
        usb.play(script);
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
    const auto events = rig.link().takeEvents();
    if (events) {
        for (const driver::Event& event : *events) outcome.events.push_back(event.code);
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
    door.with([&](sim::FaultyUsb& usb) {
        addStats(usb.device().stats(), 1, outcome);
        addFaults(usb.tally(), 1, outcome);
    });
}

Outcome measure(RigDoor& door, const RigSetup& setup, const Row& row) {
    Outcome outcome;
    beginScript(door, row.script, outcome);
    const Nanoseconds begin = door.now();
    const auto transport = door.open();
    if (transport) {
        if (auto rig = Rig::open(**transport, kSession)) {
            run(door, setup, *rig, outcome);
        } else {
            outcome.verdict = "refused";
            outcome.said += rig.error().message;
        }
    } else {
        outcome.verdict = "refused";
        outcome.said += transport.error().message;
    }
    door.close();
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
