#pragma once
// Finds rigs among the USB devices, and opens one: its handle, its strings, its stream interface
// claimed. libusb's own header stays in the source files.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "driver/udev_rule.h"
#include "driver/usb_transport.h"

struct libusb_config_descriptor;
struct libusb_context;
struct libusb_device;
struct libusb_device_handle;

namespace gonio::driver {

struct UsbFree {
    void operator()(libusb_context* context) const;
    void operator()(libusb_device* device) const;
    void operator()(libusb_device_handle* handle) const;
};
using UsbContext = std::unique_ptr<libusb_context, UsbFree>;
using UsbDeviceRef = std::unique_ptr<libusb_device, UsbFree>;
using UsbHandle = std::unique_ptr<libusb_device_handle, UsbFree>;

/// Where the descriptors say that the two halves of a rig are.
struct RigInterfaces {
    int hid = -1;
    int stream = -1;
    std::uint8_t bulkIn = 0;
    std::size_t packet = 0;  ///< bytes of the bulk endpoint
    bool readable = true;    ///< the configuration descriptor could be read at all
    [[nodiscard]] bool complete() const { return hid >= 0 && stream >= 0 && packet > 0; }
};

struct FoundRig {
    UsbDeviceRef device;
    RigInterfaces interfaces;
    UsbRig rig;
};

struct OpenedRig {
    UsbHandle handle;
    RigInterfaces interfaces;
    DeviceStrings strings;
};

/// A fresh one each time: without udev an old context never sees what was plugged in later.
[[nodiscard]] Result<UsbContext> makeUsbContext();
/// Devices of the wanted ids, and of the wanted serial where it is known; one that has not a rig's
/// interfaces has an obstacle that says so, and cannot be opened.
[[nodiscard]] Result<std::vector<FoundRig>> findRigs(libusb_context* context,
                                                     const UsbSelection& wanted);
/// Opens and reads the strings; claims nothing yet.
[[nodiscard]] Result<OpenedRig> openRig(const FoundRig& found);
/// From descriptors of any origin.
[[nodiscard]] RigInterfaces interfacesOf(const libusb_config_descriptor& config);
/// What a rig's descriptors would have and these do not; empty: nothing.
[[nodiscard]] std::string missingOf(const RigInterfaces& interfaces);
/// The text of a string descriptor, a blank for each character that is not printable ASCII (which
/// no serial number may have); empty where it is none.
[[nodiscard]] std::string textIn(std::span<const std::uint8_t> descriptor);
/// It has the descriptors of a SuperSpeed device, whatever the port gives it.
[[nodiscard]] bool canSuperSpeed(const OpenedRig& rig);
/// One control request, answered in 200 ms: 0, or libusb's error.
[[nodiscard]] int askWhetherThere(const OpenedRig& rig);
/// It is there and does not answer that request: it hangs.
[[nodiscard]] bool isSilent(const OpenedRig& rig);
/// 0, or libusb's error. The rig has to be opened anew.
[[nodiscard]] int resetPortOf(const OpenedRig& rig);
/// Resets the port of a silent rig, once until it has answered. False: that was done, another
/// program has it, or it did not help.
[[nodiscard]] bool wake(const OpenedRig& rig);
void noteAnswer(const OpenedRig& rig);
/// Takes the stream interface, from a kernel driver too.
Result<void> claimStream(const OpenedRig& rig);

/// What libusb's code means for a person who tried `what`.
[[nodiscard]] Error usbError(int code, const std::string& what);
/// "1209:0001".
[[nodiscard]] std::string idText(std::uint16_t vendor, std::uint16_t product);

}  // namespace gonio::driver
