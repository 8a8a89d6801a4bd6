#pragma once
// The computer: its kernel, udev, the store, the daemon.

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/doctor.h"
#include "daemon/finding.h"

namespace gonio::daemon {

/// usb, udev-rule, hotplug, usbfs-memory, hidraw, store, daemon: one finding each, in this order.
[[nodiscard]] std::vector<Finding> examineComputer(const Patient& patient);

/// Where a path of the patient's is, and the first line of such a file; empty where it is none.
[[nodiscard]] std::filesystem::path under(const std::filesystem::path& root,
                                          const std::string& path);
[[nodiscard]] std::string firstLine(const std::filesystem::path& file);

/// The udev rule as a person puts it into its file.
[[nodiscard]] std::string ruleInFull(const driver::UsbSelection& ids);

}  // namespace gonio::daemon
