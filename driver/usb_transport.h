#pragma once
// Rigs on USB: libusb for the stream, hidraw for the reports (PROTOCOL.md 1). Both interfaces of a
// rig are found by its serial number and opened and closed together; endpoints come from the
// descriptors. The transport keeps bulk transfers in flight by itself, in a thread of its own, as
// long as it is open. Every call ends by its deadline, closing within one second, also when the
// rig hangs: what is then still in the kernel's hands is left there and never freed.
// A device that the system might put to sleep is kept awake, or a warning says that it may not be.
// No rig: NoRig. No permission, or claimed by another program: Busy, and the message says what to
// do; both may pass, as a device node may get its permissions late. Gone, or silent: Device, and so
// is every call from then on; open it anew. A rig that is silent when it is opened gets its port
// reset, once until it has answered. As long as a port is being reset, for a second at most,
// opening and listing wait; then they are Device errors.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/protocol/transport.h"

namespace gonio::driver {

struct UsbSelection {
    std::uint16_t vendor = 0x1209;
    std::uint16_t product = 0x0001;
    std::optional<std::string> serial{};  ///< empty: the only one there is
};

/// A rig that is plugged in, whether or not it may be used.
struct UsbRig {
    std::uint16_t vendor = 0;
    std::uint16_t product = 0;
    std::string serial;       ///< empty where it cannot be read
    std::string place;        ///< bus and ports: "1-2.4"
    std::string protocol;     ///< "GRP/1.0"; empty where it cannot be read
    std::string obstacle;     ///< why it cannot be opened, and the cure; empty: it can
    int speed = 0;            ///< of the port as it is connected, Mbit/s; 0: unknown
    bool superSpeed = false;  ///< it could do 5000 Mbit/s at least
};

[[nodiscard]] Result<std::vector<UsbRig>> listUsb(const UsbSelection& wanted = {});

/// Several rigs and no serial number: a Usage error that names them.
[[nodiscard]] Result<std::unique_ptr<Transport>> openUsb(const UsbSelection& wanted = {});

}  // namespace gonio::driver
