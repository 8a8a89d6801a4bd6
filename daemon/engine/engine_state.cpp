#include "daemon/engine/engine_state.h"

#include <array>
#include <cstddef>

namespace gonio::daemon {
namespace {

using enum EngineState;
using enum EngineEvent;

struct Row {
    EngineState from;
    EngineEvent event;
    EngineState to;
};

constexpr std::array kTable{
    Row{Offline, Appeared, Connecting}, Row{Connecting, Claimed, Idle},
    Row{Connecting, Lost, Offline},     Row{Idle, JobBegun, Running},
    Row{Idle, Lost, Offline},           Row{Idle, FaultSeen, Fault},
    Row{Running, Captured, Finishing},  Row{Running, JobEnded, Idle},
    Row{Running, Lost, Interrupted},    Row{Running, FaultSeen, Fault},
    Row{Running, Hindered, Suspended},  Row{Finishing, JobEnded, Idle},
    Row{Finishing, Lost, Offline},      Row{Finishing, FaultSeen, Fault},
    Row{Suspended, Resumed, Running},   Row{Suspended, JobEnded, Idle},
    Row{Suspended, Lost, Interrupted},  Row{Interrupted, Appeared, Connecting},
    Row{Interrupted, Resumed, Running}, Row{Interrupted, JobEnded, Offline},
    Row{Fault, FaultCleared, Idle},     Row{Fault, Lost, Offline},
};

constexpr std::array<std::string_view, 8> kNames{
    "offline", "connecting", "idle", "running", "finishing", "suspended", "interrupted", "fault"};

}  // namespace

std::string_view name(EngineState state) { return kNames[static_cast<std::size_t>(state)]; }

std::optional<EngineState> next(EngineState state, EngineEvent event) {
    for (const Row& row : kTable) {
        if (row.from == state && row.event == event) return row.to;
    }
    return std::nullopt;
}

}  // namespace gonio::daemon
