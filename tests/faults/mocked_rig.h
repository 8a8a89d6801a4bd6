#pragma once
// The door of the real USB code: libusb and hidapi on a mocked bus, in real time.

#include <memory>

#include "tests/faults/rig_door.h"

namespace gonio::fault_test {

/// One at a time in a process, which must run under umockdev-wrapper.
[[nodiscard]] std::unique_ptr<RigDoor> mocked(const RigSetup& setup);

}  // namespace gonio::fault_test
