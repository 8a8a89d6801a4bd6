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
/// Shared by what was found and opened through it: the last of them ends it, wherever that is.
using UsbContext = std::shared_ptr<libusb_context>;
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
    UsbContext context;
    UsbDeviceRef device;
    RigInterfaces interfaces;
    UsbRig rig;
};

struct OpenedRig {
    UsbContext context;
    UsbHandle handle;
    RigInterfaces interfaces;
    DeviceStrings strings;
    std::string place;  ///< as in UsbRig
};

/// A fresh one each time: without udev an old context never sees what was plugged in later.
[[nodiscard]] Result<UsbContext> makeUsbContext();
/// Devices of the wanted ids, and of the wanted serial where it is known; one that has not a rig's
/// interfaces has an obstacle that says so, and cannot be opened.
[[nodiscard]] Result<std::vector<FoundRig>> findRigs(const UsbContext& context,
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
/// Takes the stream interface, from a kernel driver too. Busy: another program has it.
Result<void> claimStream(const OpenedRig& rig);

/// "rig SIM-0042"; "rig at 1-2.4" where its serial number is not known.
[[nodiscard]] std::string nameOf(const OpenedRig& rig);

/// What libusb's code means for a person who tried `what`.
[[nodiscard]] Error usbError(int code, const std::string& what);
/// "1209:0001".
[[nodiscard]] std::string idText(std::uint16_t vendor, std::uint16_t product);

}  // namespace gonio::driver
