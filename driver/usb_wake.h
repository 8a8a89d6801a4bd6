#pragma once
// A rig that does not answer: whether it is there, whether it hangs, and the reset of its port,
// which may wake it. A kernel may try for many seconds to reset a port, and as long as it tries it
// keeps everybody waiting who looks for USB devices: so nobody asks it on the thread of a caller,
// and nobody looks before it is done.

#include <chrono>

#include "driver/usb_find.h"

namespace gonio::driver {

/// The name of the thread that wakes a rig, as `top -H` and a debugger show it.
inline constexpr const char* kWakeThread = "gonio-wake";

/// Nobody waits longer for a port to be reset.
inline constexpr std::chrono::seconds kPortResetLimit{1};

/// One control request, answered in 200 ms: 0, or libusb's error.
[[nodiscard]] int askWhetherThere(const OpenedRig& rig);
/// It is there and does not answer that request: it hangs.
[[nodiscard]] bool isSilent(const OpenedRig& rig);
/// That request fails before its time is up: the port has lost its rig.
[[nodiscard]] bool isGone(const OpenedRig& rig);

/// Takes as long as the kernel does. The rig has to be opened anew.
[[nodiscard]] Result<void> resetPortOf(const OpenedRig& rig);
/// A Device error when a port is still being reset after kPortResetLimit, whoever in this process
/// asked for that.
[[nodiscard]] Result<void> awaitPortResets();

/// Resets the port of a silent rig, once until it has answered; the rig is closed then, and has to
/// be opened anew. Busy: another program has it. Device: its port was reset before, cannot be
/// reset, or is not yet after kPortResetLimit; it is reset as soon as the kernel can, then.
[[nodiscard]] Result<void> wake(OpenedRig rig);
/// It has answered: should it fall silent, its port may be reset again.
void noteAnswer(const OpenedRig& rig);

}  // namespace gonio::driver
