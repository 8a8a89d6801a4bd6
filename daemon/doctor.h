#pragma once
// Whom the doctor looks at. What it says is in doctor_system.h of the computer, in doctor_usb.h of
// a rig from outside, in doctor_rig.h of one that it has claimed; only the last changes anything.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "driver/usb_transport.h"
#include "proc/core/result.h"

namespace gonio::daemon {

/// What the daemon's status says.
struct DaemonSeen {
    int pid = 0;
    std::string rigKind{};    ///< "sim", "usb" or "replay"
    std::string rigSerial{};  ///< of the rig that it had last; empty: it has seen none yet
    std::string obstacle{};   ///< why it has no rig, or none that may be lit
};

/// What is looked at. `root` stands before every absolute path, so that a test can bring its own.
struct Patient {
    std::filesystem::path root = "/";
    std::filesystem::path store;
    Result<std::vector<driver::UsbRig>> rigs;
    Result<DaemonSeen> daemon;  ///< what asking it gave
};

/// Its serial number, or where it is plugged in.
[[nodiscard]] std::string nameOf(const driver::UsbRig& rig);
[[nodiscard]] bool usedByDaemon(const Patient& patient, const driver::UsbRig& rig);
}  // namespace gonio::daemon
