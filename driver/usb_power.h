#pragma once
// Autosuspend: the kernel may put a device that is idle to sleep, which a rig takes for a loss of
// its link (PROTOCOL.md 1 forbids it).

#include <string>

namespace gonio::driver {

/// "on", "auto"; empty where it cannot be read. `place` is bus and ports: "1-2.4".
[[nodiscard]] std::string powerControl(const std::string& place);
/// Keeps the device awake. Where that is not allowed, a warning says so, once for each place.
void keepAwake(const std::string& place);

}  // namespace gonio::driver
