#pragma once
// How a rig that was lost comes back (PROTOCOL.md 4): who opens it anew, and what is known of the
// gap afterwards.

#include <functional>
#include <optional>
#include <string>

#include "driver/protocol/reports.h"
#include "driver/protocol/transport.h"
#include "proc/core/result.h"
#include "proc/core/units.h"

namespace gonio::driver {

/// Opens the rig that was lost anew, waiting as long as its owner likes: closes the old transport,
/// which nobody touches any more, and returns the new one, or why it gives up, which ends the call
/// that was interrupted. It is called again, with the reason, when what it returned could not be
/// taken up: another serial number, a claim that is held, a rig that was lost again; it alone says
/// how often and for how long that is tried.
using Comeback = std::function<Result<Transport*>(const Error& lost)>;

/// A gap in the link to a rig that came back.
struct Interruption {
    std::string cause;
    Nanoseconds at{0};      ///< on the link's clock: when it was lost
    Nanoseconds lasted{0};  ///< until it was claimed again
    bool sameBoot = true;
    int resent = 0;  ///< frames that the rig still held
    int redone = 0;  ///< frames that are exposed again, or were not exposed yet
    /// Of the command that the loss cut off: whether the rig has done it. Empty where none was on
    /// its way, and where the rig's answer was damaged.
    std::optional<bool> cutOffDone{};
    std::optional<Stats> stats{};  ///< the rig's own counters as it came back, since its boot
};

}  // namespace gonio::driver
