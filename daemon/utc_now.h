#pragma once
// The wall clock of the computer, for the programs alone: all else is given its dates.

#include <string>

namespace gonio::daemon {

/// ISO 8601, to the second: "2026-11-30T08:41:50Z".
[[nodiscard]] std::string utcNow();

}  // namespace gonio::daemon
