#include "tests/faults/soak.h"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/faults/measurement.h"

namespace gonio::fault_test {
namespace {

using namespace std::chrono_literals;
using driver::CaptureRequest;
using driver::Rig;
using sim::FaultKind;

constexpr std::uint64_t kSession = 0x1122334455667788;
constexpr int kForever = std::numeric_limits<int>::max();
constexpr Nanoseconds kFeed = 50ms;      // so often is the heartbeat fed between captures
constexpr Nanoseconds kNoticed = 300ms;  // FAULTS.md F01
constexpr int kCalm = 2;                 // captures without a fault: the last one is over
constexpr Nanoseconds kLongest = 60s;    // without the rig, though it is there again

/// All that a rig survives without a redone bracket, and a loss of power. Frames that are never
/// valid again (interlock, heat) and rigs that never come back are rows of their own.
constexpr const char* kFaults =
    " lose chunk or duplicate chunk or swap chunks or flip 1..3 bits in payload or "
    "burst of 2..32 bits in payload or flip 1..3 bits in header or shorten chunk or "
    "lengthen chunk or empty packet or overflow or stall bulk or break transfer or lose ack or "
    "lose command or delay ack 120ms..180ms or unknown report or unknown chunk or unknown event "
    "or spoil report or drop 1..2 reports or unplug for 200ms..900ms or "
    "unplug quietly for 200ms..900ms or lose power for 200ms..900ms or "
    "plug as SIM-0666 for 200ms..900ms or hang until reset or memory for 2..6 transfers for 1s or "
    "jump clock -10s..10s or silence reports or drifting led\n";

sim::FaultScript scriptOf(const SoakPlan& plan) {
    auto script = sim::FaultScript::parse("every " + plan.every + kFaults);
    if (!script) throw std::runtime_error(script.error().message);
    script->seed = plan.seed;
    return std::move(*script);
}

/// Exposed for more than half of the time, so that what happens by the clock happens in frames too.
CaptureRequest requestOf(int capture) {
    const auto step = static_cast<std::uint64_t>(capture) + 1;
    return {.planStep = step,
            .led = static_cast<int>(step % 3),
            .levels = LedLevels::only(kBands[step % 3], 1000),
            .exposure = Microseconds(50'000),
            .frames = SoakPlan::kFramesPerCapture};
}

/// What the script did, kind by kind.
int did(const Outcome& outcome, std::initializer_list<FaultKind> kinds) {
    int sum = 0;
    for (const FaultKind kind : kinds)
        sum += outcome.counts.at("did " + std::string(sim::faultName(kind)));
    return sum;
}

/// Of another fault.
bool isAnEnd(FaultKind kind) {
    return kind == FaultKind::Plug || kind == FaultKind::PlugRebooted ||
           kind == FaultKind::EndLimit;
}

std::map<std::string, int> allThat(const Outcome& outcome) {
    std::map<std::string, int> kinds;
    for (std::size_t i = 0; i < sim::kFaultKinds; ++i) {
        const auto kind = static_cast<FaultKind>(i);
        const int times = did(outcome, {kind});
        if (times > 0 && !isAnEnd(kind)) kinds.emplace(sim::faultName(kind), times);
    }
    return kinds;
}

class Soak {
public:
    Soak(RigDoor& door, const RigSetup& setup, const SoakPlan& plan)
        : door_(door), setup_(setup), plan_(plan), calm_(inProcess(setup, kForever)) {}

    Soaked run() {
        auto rig = opened(door_);
        auto twin = opened(*calm_);
        rig.onLost(comebackThrough(door_, outcome_, {.comebacks = kForever, .each = kLongest}));
        beginScript(door_, scriptOf(plan_), outcome_);
        const Nanoseconds begin = door_.now();
        boot_ = rig.bootId();
        // The planned ones, and a few more, until the last fault is over.
        int calm = 0;
        for (int i = 0; (i < plan_.captures || calm < kCalm) && outcome_.troubles.empty(); ++i) {
            const int before = faultsSoFar();
            take(i, rig, twin);
            while (door_.now() < begin + (i + 1) * SoakPlan::kCapturePeriod) {
                door_.pause(kFeed);
                expect(rig.keepAlive(), i);
            }
            calm = faultsSoFar() == before ? calm + 1 : 0;
        }
        soaked_.lasted = door_.now() - begin;
        judge(rig);
        (void)rig.close();
        return std::move(soaked_);
    }

private:
    Rig opened(RigDoor& door) {
        const auto transport = door.open();
        if (!transport) throw std::runtime_error(transport.error().message);
        auto rig = Rig::open(**transport, kSession);
        if (!rig) throw std::runtime_error(rig.error().message);
        if (const auto set = rig->configure(setup_.window); !set)
            throw std::runtime_error(set.error().message);
        return std::move(*rig);
    }
    template <class T>
    bool expect(const Result<T>& done, int capture) {
        if (!done) trouble(capture, done.error().message);
        return static_cast<bool>(done);
    }
    void trouble(int capture, const std::string& what) {
        outcome_.troubles.push_back("capture " + std::to_string(capture) + ": " + what);
    }
    int faultsSoFar() {
        int sum = 0;
        door_.with([&](sim::FaultyUsb& usb) {
            for (std::size_t i = 0; i < sim::kFaultKinds; ++i) {
                const auto kind = static_cast<FaultKind>(i);
                if (!isAnEnd(kind)) sum += usb.tally().of(kind);
            }
        });
        return sum;
    }
    void take(int i, Rig& rig, Rig& twin) {
        const auto wanted = twin.capture(requestOf(i));
        auto seen = rig.capture(requestOf(i));
        if (!seen && rig.bootId() != boot_) {  // said once
            boot_ = rig.bootId();
            seen = rig.capture(requestOf(i));
        }
        noteInterruptions(rig, outcome_);
        ++soaked_.captures;
        if (!expect(wanted, i) || !expect(seen, i)) return;
        if (seen->size() != wanted->size()) return trouble(i, "frames are missing");
        for (std::size_t k = 0; k < seen->size(); ++k) {
            if ((*seen)[k].pixels != (*wanted)[k].pixels) trouble(i, "another picture");
            ++soaked_.frames;
        }
    }
    void judge(Rig& rig) {
        readBack(rig, door_, outcome_);
        soaked_.interruptions = outcome_.counts["interruptions"];
        soaked_.kinds = allThat(outcome_);
        for (const auto& [kind, times] : soaked_.kinds) soaked_.faults += times;
        soaked_.pulls = did(outcome_,
                            {FaultKind::Unplug,
                             FaultKind::UnplugQuietly,
                             FaultKind::LosePower,
                             FaultKind::PlugAs,
                             FaultKind::HangUntilReset});
        soaked_.noticed = outcome_.detected;
        forgive();
        outcome_.slack = door_.slack();
        outcome_.verdict = "completed";
        outcome_.said.clear();
        soaked_.troubles = complaints(wishes(), outcome_, {});
    }
    void forgive() {
        auto& counts = outcome_.counts;
        // The last chunk of a capture, come again, is stale: the capture is over.
        counts["duplicates"] += std::exchange(counts["stale"], 0);
        if (!plan_.realTime || soaked_.interruptions == soaked_.pulls) return;
        // Lost by a busy machine while it streams, a rig has chunks of a capture that nobody waits
        // for any more, and reports that nobody hears.
        const auto forgiven = [&](const char* counter, FaultKind cause, bool more) {
            const int caused = did(outcome_, {cause});
            counts[counter] =
                more ? std::min(counts[counter], caused) : std::max(counts[counter], caused);
        };
        forgiven("duplicates", FaultKind::DuplicateChunk, true);
        forgiven("unknownReports", FaultKind::UnknownReport, false);
        forgiven("badReports", FaultKind::SpoilReport, false);
    }
    /// As a row has them.
    [[nodiscard]] Row wishes() const {
        const std::string exactly = plan_.realTime ? ">=" : "=";
        Row row{.name = "soak", .script = {}, .verdict = "completed"};
        row.counts = {{"interruptions", exactly, soaked_.pulls},
                      {"reopens", exactly, did(outcome_, {FaultKind::SilenceReports})}};
        if (outcome_.detected > Nanoseconds(0)) row.detected = kNoticed;
        return row;
    }

    RigDoor& door_;
    const RigSetup& setup_;
    const SoakPlan& plan_;
    std::unique_ptr<RigDoor> calm_;
    std::uint32_t boot_ = 0;
    Outcome outcome_;
    Soaked soaked_;
};

}  // namespace

Soaked soak(RigDoor& door, const RigSetup& setup, const SoakPlan& plan) {
    Soaked soaked = Soak(door, setup, plan).run();
    door.close();
    return soaked;
}

std::string summaryOf(const Soaked& soaked) {
    std::ostringstream text;
    text << soaked.frames << " frames, " << soaked.faults << " faults, " << soaked.interruptions
         << " interruptions (" << soaked.pulls << " caused), a pulled cable noticed after "
         << soaked.noticed / 1ms << " ms at most, " << soaked.lasted / 1s
         << " s of the rig's time\nfaults:";
    for (const auto& [kind, times] : soaked.kinds) text << ' ' << times << " x " << kind << ';';
    return text.str();
}

}  // namespace gonio::fault_test
