// What a rig does when it was lost and comes back (PROTOCOL.md 4, point 5).

#include <utility>

#include "driver/rig.h"

namespace gonio::driver {
namespace {

// In one call: a rig that comes back and is lost again each time, at the same point, would never
// end either.
constexpr int kMostComebacks = 20;

}  // namespace

Result<void> Rig::comeBack(const Error& lost) {
    // A fault of the stream ends the call; the next one may try.
    if (lost.deviceStatus == status::kLink && !std::exchange(faultTold_, true)) return lost;
    if (comebacks_ >= mostComebacks_) return lostTooOften(lost);
    const std::uint32_t boot = boot_;  // another one may have been seen since, and lost again
    const Clock& clock = link_->clock();
    Interruption gap{.cause = lost.message, .at = clock.now()};
    Error why = lost;
    while (true) {
        const Result<Transport*> opened = onLost_(why);
        if (!opened) return opened.error();
        if (auto taken = takeUp(**opened); !taken) {
            why = taken.error();
            link_->abandon(why);
            continue;
        }
        gap.lasted = clock.now() - gap.at;
        gap.sameBoot = bootId() == boot;
        if (!gap.sameBoot) {
            rebooted_ = Error{ErrorKind::Device,
                              "rig " + link_->strings().serial + " has lost its power: boot id " +
                                  std::to_string(bootId()) + ", was " + std::to_string(boot) +
                                  "; redo the bracket"};
            rebootTold_ = false;
        }
        boot_ = bootId();
        faultTold_ = false;
        ++comebacks_;
        interruptions_.push_back(std::move(gap));
        if (onBack_) onBack_();
        return {};
    }
}

/// Once.
std::optional<Error> Rig::tellReboot() {
    if (!rebooted_ || std::exchange(rebootTold_, true)) return std::nullopt;
    return rebooted_;
}

/// Claimed, dark and idle, with nothing on its way. The format is set again even to the same boot:
/// another program may have had the rig meanwhile.
Result<void> Rig::takeUp(Transport& transport) {
    if (auto claimed = link_->resume(transport); !claimed) return claimed;
    if (auto idle = abort(); !idle) return idle;
    return geometry_ ? setFormat(*geometry_) : Result<void>();
}

Error Rig::lostTooOften(const Error& lost) const {
    return {lost.kind,
            "lost " + std::to_string(kMostComebacks + 1) +
                " times in one call, at last: " + lost.message,
            lost.deviceStatus};
}

void Rig::beginCall() { mostComebacks_ = comebacks_ + kMostComebacks; }

/// Of the frames still missing, those that the rig holds.
Result<void> Rig::askForHeld(const ArmedCapture& armed, CaptureProgress& progress) {
    progress.interrupt();
    const auto held = Collector(*link_, assembler_, pixels_).askForAll(armed, progress);
    if (!held) return held.error();
    if (interruptions_.empty()) return {};  // a sink has taken them
    interruptions_.back().resent += held->held;
    interruptions_.back().redone += held->gone;
    return {};
}

std::vector<Interruption> Rig::takeInterruptions() { return std::exchange(interruptions_, {}); }

}  // namespace gonio::driver
