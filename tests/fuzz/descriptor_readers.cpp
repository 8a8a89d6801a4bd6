// Descriptors that a device may make up as it likes, read by the libusb of this computer as from a
// device of its own, and by the driver from what libusb makes of them. No device is there: libusb
// is given a file that holds them, and this program answers the few requests that it makes of one.

#include <libusb.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdarg>
#include <utility>

#include "driver/protocol/wire.h"
#include "driver/usb_find.h"
#include "sim/usb_descriptors.h"
#include "tests/fuzz/usb_readers.h"

namespace gonio::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// The device in question: the file that libusb takes for it, what it answers to a request, and the
/// request that it has not answered yet.
struct Device {
    int file = -1;
    std::span<const std::uint8_t> answer{};
    usbdevfs_urb* asked = nullptr;
};
Device& device() {
    static Device device;
    return device;
}

/// As the kernel would, for the requests that reading descriptors takes.
int answerLibusb(unsigned long request, void* argument) {
    constexpr int kSetup = 8;
    switch (request) {
        case USBDEVFS_CONNECTINFO:
            *static_cast<usbdevfs_connectinfo*>(argument) = {.devnum = 1, .slow = 0};
            return 0;
        case USBDEVFS_SUBMITURB: {
            auto* urb = static_cast<usbdevfs_urb*>(argument);
            const auto length = std::min<std::size_t>(
                device().answer.size(), static_cast<std::size_t>(urb->buffer_length - kSetup));
            std::copy_n(
                device().answer.begin(), length, static_cast<std::uint8_t*>(urb->buffer) + kSetup);
            urb->status = device().answer.empty() ? -EPIPE : 0;
            urb->actual_length = static_cast<int>(length);
            device().asked = urb;
            return 0;
        }
        case USBDEVFS_REAPURBNDELAY:
            if (device().asked == nullptr) break;
            *static_cast<usbdevfs_urb**>(argument) = std::exchange(device().asked, nullptr);
            return 0;
        default: break;
    }
    errno = request == USBDEVFS_REAPURBNDELAY ? EAGAIN : ENOTTY;
    return -1;
}

libusb_context* context() {
    static const driver::UsbContext kContext = [] {
        libusb_set_option(nullptr, LIBUSB_OPTION_NO_DEVICE_DISCOVERY);
        auto made = driver::makeUsbContext();
        return made ? std::move(*made) : nullptr;
    }();
    return kContext.get();
}

driver::UsbHandle opened(std::span<const std::uint8_t> descriptors) {
    if (ftruncate(device().file, 0) != 0) return nullptr;
    const auto size = static_cast<ssize_t>(descriptors.size());
    if (pwrite(device().file, descriptors.data(), descriptors.size(), 0) != size) return nullptr;
    libusb_device_handle* handle = nullptr;
    (void)libusb_wrap_sys_device(context(), device().file, &handle);
    return driver::UsbHandle(handle);
}

std::string input(const Bytes& descriptors, const Bytes& answer) {
    Bytes all(2);
    driver::put(std::span(all), 0, static_cast<std::uint16_t>(descriptors.size()));
    all.insert(all.end(), descriptors.begin(), descriptors.end());
    all.insert(all.end(), answer.begin(), answer.end());
    return textOf(all);
}

}  // namespace

std::vector<std::string> soundDescriptors() {
    std::vector<std::string> all;
    for (const auto kind : {sim::CameraKind::Usb2, sim::CameraKind::Usb3}) {
        Bytes descriptors = sim::usb::deviceDescriptor({}, kind);
        const Bytes config = sim::usb::configDescriptor(kind);
        descriptors.insert(descriptors.end(), config.begin(), config.end());
        all.push_back(input(descriptors, sim::usb::bosDescriptor(kind).value_or(Bytes{})));
        for (const std::uint8_t index : std::array<std::uint8_t, 4>{0, 1, 3, 240}) {
            if (const auto text = sim::usb::stringDescriptor(index, "SIM-0001"))
                all.push_back(input(descriptors, *text));
        }
    }
    return all;
}

std::optional<Error> readDescriptors(std::string_view text) {
    const Bytes all = bytesOf(text);
    if (all.size() < 2) return std::nullopt;
    if (device().file < 0) device().file = memfd_create("descriptors", MFD_CLOEXEC);
    if (device().file < 0 || context() == nullptr) return wrong("libusb does not begin");
    const auto rest = std::span<const std::uint8_t>(all).subspan(2);
    const auto length = std::min<std::size_t>(driver::get<std::uint16_t>(all, 0), rest.size());
    device().answer = rest.subspan(length);
    const std::string string = driver::textIn(device().answer);
    if (string.size() > device().answer.size() / 2) return wrong("more text than bytes");
    const bool plain = std::all_of(
        string.begin(), string.end(), [](char letter) { return letter >= ' ' && letter <= '~'; });
    if (!plain) return wrong("a string that is no text");
    driver::OpenedRig rig{.handle = opened(rest.first(length)), .interfaces = {}, .strings = {}};
    if (!rig.handle) return std::nullopt;
    (void)driver::canSuperSpeed(rig);
    libusb_config_descriptor* config = nullptr;
    if (libusb_get_active_config_descriptor(libusb_get_device(rig.handle.get()), &config) != 0)
        return std::nullopt;
    const driver::RigInterfaces found = driver::interfacesOf(*config);
    libusb_free_config_descriptor(config);
    if (found.complete() && (found.bulkIn & LIBUSB_ENDPOINT_IN) == 0)
        return wrong("a stream that does not come in");
    return std::nullopt;
}

}  // namespace gonio::test

/// Of an interface whose descriptor is of another kind libusb 1.0.26 forgets 40 bytes.
extern "C" const char* __lsan_default_suppressions() { return "leak:libusb-1.0.so\n"; }  // NOLINT

/// Stands before libc's, for libusb too: what is no request to the device goes where it went.
extern "C" int ioctl(int descriptor, unsigned long request, ...) noexcept {
    va_list arguments;
    va_start(arguments, request);
    void* argument = va_arg(arguments, void*);
    va_end(arguments);
    if (descriptor >= 0 && descriptor == gonio::test::device().file)
        return gonio::test::answerLibusb(request, argument);
    return static_cast<int>(syscall(SYS_ioctl, descriptor, request, argument));
}
