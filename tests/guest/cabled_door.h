#pragma once
// The door of a real kernel: a simulated rig on a port of vhci-hcd, in real time.

#include <memory>

#include "tests/faults/rig_door.h"

namespace gonio::guest_test {

/// One at a time.
[[nodiscard]] std::unique_ptr<fault_test::RigDoor> cabled(const fault_test::RigSetup& setup);

}  // namespace gonio::guest_test
