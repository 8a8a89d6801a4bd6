// What a rig does when it was lost and comes back (PROTOCOL.md 4, point 5).

#include <utility>

#include "driver/rig.h"

namespace gonio::driver {
namespace {

// Transports that could not be taken up, one after the other: an owner that has nothing better
// would never end.
constexpr int kMostTries = 1000;

}  // namespace

Result<void> Rig::comeBack(const Error& lost) {
    // A stream that fails again and again is a fault: the rig is there, and would fail again.
    if (lost.deviceStatus == status::kLink) return lost;
    const std::uint32_t boot = bootId();
    const Clock& clock = link_->clock();
    Interruption gap{.cause = lost.message, .at = clock.now()};
    Error why = lost;
    for (int tries = 0; tries < kMostTries; ++tries) {
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
        }
        interruptions_.push_back(std::move(gap));
        return {};
    }
    return why;
}

/// Claimed, dark and idle, with nothing on its way. The format is set again even to the same boot:
/// another program may have had the rig meanwhile.
Result<void> Rig::takeUp(Transport& transport) {
    if (auto claimed = link_->resume(transport); !claimed) return claimed;
    if (auto idle = abort(); !idle) return idle;
    return geometry_ ? setFormat(*geometry_) : Result<void>();
}

/// Of the frames still missing, those that the rig holds.
Result<void> Rig::collectAgain(const ArmedCapture& armed, const Making& making) {
    Interruption& gap = interruptions_.back();
    CaptureProgress& progress = making.progress;
    progress.interrupt();
    const auto held = Collector(*link_, assembler_, pixels_).askForAll(armed, progress);
    if (!held) return held.error();
    gap.resent += held->held;
    gap.redone += held->gone;
    return collect(armed, making);
}

std::vector<Interruption> Rig::takeInterruptions() { return std::exchange(interruptions_, {}); }

}  // namespace gonio::driver
