#pragma once
// Who stands by while pictures are taken: is told of what went wrong and was survived, and has the
// rig put right where the sequencer cannot.

#include <functional>
#include <string>
#include <string_view>

#include "proc/core/result.h"

namespace gonio::daemon {

/// Why a bracket is taken again, or a frame was.
struct Setback {
    enum class Cause {
        NewBoot,    ///< the rig came back without what it had been told
        Suspended,  ///< it would not light for a while
        Repeated,   ///< the picture before, once more
        Blank,      ///< no picture
        Unlit,      ///< no light in a lit frame
        Exposure,   ///< another exposure than its LEADER says, or another light
        Reflex,     ///< light that is not the sample's
        Rejected    ///< by what the rig says of it: the driver has taken it again
    };
    Cause cause = Cause::Rejected;
    std::string bracket;  ///< "LED 2 g", or "dark"
    std::string message;
};
/// "new-boot", "suspended", "repeated", ...
[[nodiscard]] std::string_view name(Setback::Cause cause);

struct Attendance {
    /// Called before each capture, and every few seconds at least between two of them.
    std::function<void()> alive = [] {};
    /// The rig does not light: its interlock is open, or it is too warm. Returns once it may light
    /// again; an error ends the measurement.
    std::function<Result<void>(const Error& why)> suspended = [](const Error& why) {
        return Result<void>(why);
    };
    std::function<void(const Setback&)> setback = [](const Setback&) {};
    /// All frames are there: nobody needs to wait for the rig any more. Perhaps more than once.
    std::function<void()> captured = [] {};
};

}  // namespace gonio::daemon
