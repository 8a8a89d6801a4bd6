#include <libusb.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <utility>

#include "driver/usb_find.h"

namespace gonio::driver {
namespace {

constexpr unsigned kControlMs = 500;
constexpr std::uint8_t kProtocolString = 240;
constexpr std::uint8_t kStreamSubClass = 0x47, kStreamProtocol = 0x01;

std::string hex4(std::uint16_t value) {
    constexpr const char* kDigits = "0123456789abcdef";
    std::string text;
    for (int shift = 12; shift >= 0; shift -= 4) text += kDigits[value >> shift & 0xF];
    return text;
}

/// "1-2.4", as sysfs names it.
std::string placeOf(libusb_device* device) {
    std::array<std::uint8_t, 8> ports{};
    const int depth = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
    std::string place = std::to_string(libusb_get_bus_number(device));
    for (int i = 0; i < depth; ++i) {
        place += (i == 0 ? "-" : ".") + std::to_string(ports[static_cast<std::size_t>(i)]);
    }
    return place;
}

/// The kernel's copy of the serial number, which needs no permission to read.
std::string knownSerial(const std::string& place) {
    std::ifstream file("/sys/bus/usb/devices/" + place + "/serial");
    std::string serial;
    std::getline(file, serial);
    const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
    std::replace_if(serial.begin(), serial.end(), std::not_fn(printable), '?');
    return serial;
}

/// Mbit/s; 0: unknown.
int speedOf(libusb_device* device) {
    switch (libusb_get_device_speed(device)) {
        case LIBUSB_SPEED_LOW: return 1;
        case LIBUSB_SPEED_FULL: return 12;
        case LIBUSB_SPEED_HIGH: return 480;
        case LIBUSB_SPEED_SUPER: return 5000;
        case LIBUSB_SPEED_SUPER_PLUS: return 10000;
        default: return 0;
    }
}

RigInterfaces interfacesOf(libusb_device* device) {
    libusb_config_descriptor* config = nullptr;
    if (libusb_get_active_config_descriptor(device, &config) != 0) return {.readable = false};
    const RigInterfaces found = driver::interfacesOf(*config);
    libusb_free_config_descriptor(config);
    return found;
}

std::string stringOf(libusb_device_handle* handle, std::uint8_t index) {
    if (index == 0) return {};  // the device has no such string
    constexpr std::uint16_t kEnglish = 0x0409;
    std::array<std::uint8_t, 255> raw{};
    const int n = libusb_control_transfer(handle,
                                          LIBUSB_ENDPOINT_IN,
                                          LIBUSB_REQUEST_GET_DESCRIPTOR,
                                          static_cast<std::uint16_t>(LIBUSB_DT_STRING << 8 | index),
                                          kEnglish,
                                          raw.data(),
                                          static_cast<std::uint16_t>(raw.size()),
                                          kControlMs);
    return n < 0 ? std::string() : textIn(std::span(raw).first(static_cast<std::size_t>(n)));
}

}  // namespace

RigInterfaces interfacesOf(const libusb_config_descriptor& config) {
    RigInterfaces found;
    for (int i = 0; i < config.bNumInterfaces; ++i) {
        const libusb_interface& interface = config.interface[i];
        if (interface.num_altsetting < 1) continue;
        const libusb_interface_descriptor& main = interface.altsetting[0];
        const bool hid = main.bInterfaceClass == LIBUSB_CLASS_HID;
        if (hid && found.hid < 0) found.hid = main.bInterfaceNumber;
        if (main.bInterfaceClass != LIBUSB_CLASS_VENDOR_SPEC ||
            main.bInterfaceSubClass != kStreamSubClass ||
            main.bInterfaceProtocol != kStreamProtocol)
            continue;
        if (found.stream < 0) found.stream = main.bInterfaceNumber;
        // Of an interface whose descriptors end too soon libusb has no endpoints, whatever it
        // counts.
        for (int e = 0; main.endpoint != nullptr && e < main.bNumEndpoints; ++e) {
            const libusb_endpoint_descriptor& endpoint = main.endpoint[e];
            const bool in = (endpoint.bEndpointAddress & LIBUSB_ENDPOINT_IN) != 0;
            if (!in || (endpoint.bmAttributes & 3) != LIBUSB_TRANSFER_TYPE_BULK) continue;
            if (found.packet > 0) break;  // the first there is
            found.stream = main.bInterfaceNumber;
            found.bulkIn = endpoint.bEndpointAddress;
            found.packet = endpoint.wMaxPacketSize & 0x7FFU;
        }
    }
    return found;
}

std::string missingOf(const RigInterfaces& interfaces) {
    if (!interfaces.readable)
        return "its configuration descriptor cannot be read: a length or a count in it is wrong";
    if (interfaces.hid < 0) return "its descriptors have no HID interface (bInterfaceClass 3)";
    if (interfaces.stream < 0)
        return "its descriptors have no stream interface (bInterfaceClass 255, bInterfaceSubClass "
               "71, bInterfaceProtocol 1)";
    const std::string stream = std::to_string(interfaces.stream);
    if (interfaces.bulkIn == 0)
        return "interface " + stream + " has no bulk IN endpoint (bEndpointAddress, bmAttributes)";
    if (interfaces.packet == 0)
        return "the bulk endpoint of interface " + stream + " has wMaxPacketSize 0";
    return {};
}

std::string textIn(std::span<const std::uint8_t> raw) {
    if (raw.size() < 2 || raw[0] < 2 || raw[1] != LIBUSB_DT_STRING) return {};
    std::string text;
    for (std::size_t i = 2; i + 1 < std::min<std::size_t>(raw[0], raw.size()); i += 2) {
        const bool printable = raw[i + 1] == 0 && raw[i] >= ' ' && raw[i] <= '~';
        text += printable ? static_cast<char>(raw[i]) : ' ';
    }
    return text;
}

void UsbFree::operator()(libusb_context* context) const { libusb_exit(context); }
void UsbFree::operator()(libusb_device* device) const { libusb_unref_device(device); }
void UsbFree::operator()(libusb_device_handle* handle) const { libusb_close(handle); }

std::string idText(std::uint16_t vendor, std::uint16_t product) {
    return hex4(vendor) + ":" + hex4(product);
}

Error usbError(int code, const std::string& what) {
    const std::string seen = what + ": " + libusb_error_name(code);
    switch (code) {
        case LIBUSB_ERROR_ACCESS: return {ErrorKind::Busy, seen + " (no permission)"};
        case LIBUSB_ERROR_BUSY:
            return {ErrorKind::Busy, seen + " (claimed by another program: close it)"};
        case LIBUSB_ERROR_NO_DEVICE:
            return {ErrorKind::Device, seen + " (it is gone; check its cable and power)"};
        default: return {ErrorKind::Device, seen};
    }
}

Result<UsbContext> makeUsbContext() {
    libusb_context* context = nullptr;
    const int code = libusb_init(&context);
    if (code != 0) return usbError(code, "start libusb");
    return UsbContext(context, UsbFree());
}

Result<std::vector<FoundRig>> findRigs(const UsbContext& context, const UsbSelection& wanted) {
    libusb_device** list = nullptr;
    const auto count = libusb_get_device_list(context.get(), &list);
    if (count < 0) return usbError(static_cast<int>(count), "list USB devices");
    std::vector<FoundRig> rigs;
    for (auto i = decltype(count){0}; i < count; ++i) {
        UsbDeviceRef device(list[i]);
        libusb_device_descriptor descriptor{};
        if (libusb_get_device_descriptor(device.get(), &descriptor) != 0) continue;
        if (descriptor.idVendor != wanted.vendor || descriptor.idProduct != wanted.product)
            continue;
        const RigInterfaces interfaces = interfacesOf(device.get());
        const std::string place = placeOf(device.get());
        const int speed = speedOf(device.get());
        const std::string serial = knownSerial(place);
        if (wanted.serial && !serial.empty() && serial != *wanted.serial) continue;
        rigs.push_back({.context = context,
                        .device = std::move(device),
                        .interfaces = interfaces,
                        .rig = {.vendor = descriptor.idVendor,
                                .product = descriptor.idProduct,
                                .serial = serial,
                                .place = place,
                                .protocol = {},
                                .obstacle = missingOf(interfaces),
                                .speed = speed}});
    }
    libusb_free_device_list(list, 0);
    return rigs;
}

Result<OpenedRig> openRig(const FoundRig& found) {
    const UsbRig& rig = found.rig;
    libusb_device_handle* raw = nullptr;
    const int code = libusb_open(found.device.get(), &raw);
    if (code != 0) {
        Error error = usbError(code, "open rig " + rig.serial + " at " + rig.place);
        if (code == LIBUSB_ERROR_ACCESS)
            error.message += ": " + permissionCure(rig.vendor, rig.product);
        return error;
    }
    OpenedRig opened{.context = found.context,
                     .handle = UsbHandle(raw),
                     .interfaces = found.interfaces,
                     .strings = {},
                     .place = rig.place};
    libusb_device_descriptor descriptor{};
    (void)libusb_get_device_descriptor(found.device.get(), &descriptor);  // cached: cannot fail
    opened.strings = {.vendor = rig.vendor,
                      .product = rig.product,
                      .serial = stringOf(raw, descriptor.iSerialNumber),
                      .protocol = stringOf(raw, kProtocolString)};
    return opened;
}

bool canSuperSpeed(const OpenedRig& rig) {
    libusb_bos_descriptor* bos = nullptr;
    if (libusb_get_bos_descriptor(rig.handle.get(), &bos) != 0) return false;  // USB 2.0 has none
    bool can = false;
    for (int i = 0; i < bos->bNumDeviceCaps; ++i) {
        can |= bos->dev_capability[i]->bDevCapabilityType == LIBUSB_BT_SS_USB_DEVICE_CAPABILITY;
    }
    libusb_free_bos_descriptor(bos);
    return can;
}

Result<void> claimStream(const OpenedRig& rig) {
    // Not supported on a system without kernel drivers to detach: then there is nothing to do.
    (void)libusb_set_auto_detach_kernel_driver(rig.handle.get(), 1);
    const int code = libusb_claim_interface(rig.handle.get(), rig.interfaces.stream);
    if (code != 0) return usbError(code, "claim the stream of " + nameOf(rig));
    return {};
}

std::string nameOf(const OpenedRig& rig) {
    const std::string& serial = rig.strings.serial;
    return "rig " + (serial.empty() ? "at " + rig.place : serial);
}

}  // namespace gonio::driver
