#pragma once
// What a daemon's rig is doing, as a table: from each state, what may happen, and where it leads.
// What the table does not have cannot happen, and changes nothing.

#include <optional>
#include <string_view>

namespace gonio::daemon {

enum class EngineState {
    Offline,      ///< no rig; it is looked for
    Connecting,   ///< a rig is there and is being claimed
    Idle,         ///< ready, dark
    Running,      ///< a job takes frames
    Finishing,    ///< a job has its frames and computes
    Suspended,    ///< the rig does not light in the middle of a job; it waits for a person
    Interrupted,  ///< the rig was lost in the middle of a job; it is looked for
    Fault         ///< the rig refuses to light until the cause is gone
};

enum class EngineEvent {
    Appeared,
    Claimed,
    Lost,
    JobBegun,
    Captured,
    JobEnded,
    Hindered,  ///< a job's light is off until the interlock is closed, or the rig is cooler
    Resumed,   ///< the job goes on
    FaultSeen,
    FaultCleared
};

[[nodiscard]] std::string_view name(EngineState state);
/// Empty: this cannot happen in that state.
[[nodiscard]] std::optional<EngineState> next(EngineState state, EngineEvent event);

}  // namespace gonio::daemon
