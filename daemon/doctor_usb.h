#pragma once
// A rig that is plugged in, seen from outside: what sysfs, /proc and its strings say of it. Nothing
// of it is claimed.

#include <string>
#include <vector>

#include "daemon/doctor.h"
#include "daemon/finding.h"

namespace gonio::daemon {

/// permission, protocol, kernel-driver, hidraw-node, speed, autosuspend, holder: one finding each,
/// in this order.
[[nodiscard]] std::vector<Finding> examineOutside(const Patient& patient,
                                                  const driver::UsbRig& rig);

/// Of the daemon's rig on USB, where it is not among those that this program was shown; `said`: the
/// daemon's findings of it. In a container that is no reason to call it unplugged.
[[nodiscard]] Finding unshown(const Patient& patient, const std::vector<Finding>& said);

/// Its version of the protocol ("GRP/1.0"; empty: not known) and ours.
[[nodiscard]] Finding protocolFinding(const std::string& protocol);

/// What stands against claiming the rig now: no permission, or somebody has it. Empty: nothing.
[[nodiscard]] std::string inTheWay(const Patient& patient, const driver::UsbRig& rig);

}  // namespace gonio::daemon
