#pragma once
// What stands between a user and a measurement on this computer: permissions, the kernel's limits,
// the store, the daemon. Looks and changes nothing; each finding says what to do.

#include <filesystem>
#include <string>
#include <vector>

#include "driver/usb_transport.h"
#include "proc/core/result.h"

namespace gonio::daemon {

enum class Verdict {
    Good,
    Note,     ///< works, or is not needed here
    Warning,  ///< will be missed sooner or later
    Bad       ///< nothing can be measured like this
};
[[nodiscard]] std::string_view name(Verdict verdict);

struct Finding {
    std::string subject;  ///< "udev-rule"
    Verdict verdict = Verdict::Good;
    std::string seen;
    std::string cure;  ///< empty: nothing to do
};

/// What is looked at. `root` stands before every absolute path, so that a test can bring its own.
struct Patient {
    std::filesystem::path root = "/";
    std::filesystem::path store;
    Result<std::vector<driver::UsbRig>> rigs;
    Result<void> daemon;  ///< what asking it gave
};

/// usb, permission, udev-rule, hotplug, usbfs-memory, hidraw, store, daemon: one finding each, in
/// this order.
[[nodiscard]] std::vector<Finding> examine(const Patient& patient);

}  // namespace gonio::daemon
