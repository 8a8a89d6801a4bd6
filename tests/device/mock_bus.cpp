#include "tests/device/mock_bus.h"

#include <umockdev.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>

#include "tests/device/hidraw_node.h"
#include "tests/device/usbfs_node.h"

namespace gonio::device_test {
namespace {

using namespace std::chrono_literals;

std::string owned(gchar* text) {
    std::string copy = text;
    g_free(text);
    return copy;
}

}  // namespace

std::string hex(std::span<const std::uint8_t> bytes) {
    constexpr const char* kDigits = "0123456789ABCDEF";
    std::string text;
    for (std::uint8_t b : bytes) {
        text += kDigits[b >> 4];
        text += kDigits[b & 15];
    }
    return text;
}

MockBus::MockBus() : testbed_(umockdev_testbed_new()) {
    if (!umockdev_in_mock_environment()) throw std::runtime_error("run under umockdev-wrapper");
}

MockBus::~MockBus() { g_object_unref(testbed_); }

std::string MockBus::real(const std::string& path) const {
    return owned(umockdev_testbed_get_root_dir(testbed_)) + path;
}

MockRig::MockRig(MockBus& bus, sim::DeviceConfig config, int port)
    : bus_(bus), live_(config), serial_(config.serial), port_(port) {
    plug();
    hand_ = std::jthread([this](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            watchTheCable();
            std::this_thread::sleep_for(1ms);
        }
    });
}

MockRig::~MockRig() {
    hand_.request_stop();
    hand_.join();
    live_.faults.hung = false;  // whoever is stuck in a request comes back
    live_.with([](sim::FaultyUsb& usb) { usb.cause(sim::FaultKind::EndHang); });
    unplug();
}

std::string MockRig::usbNode() const { return "/dev/bus/usb/001/" + std::to_string(number_); }
std::string MockRig::hidName() const { return "0003:1209:0001.0" + std::to_string(hidNumber_); }
std::string MockRig::hidNode() const { return "/dev/hidraw" + std::to_string(hidNumber_); }

/// What sysfs and udev of a Linux say of such a device.
std::string MockRig::description() {
    std::vector<std::uint8_t> descriptors;
    std::string speed;  // Mbit/s
    live_.with([&](sim::FaultyUsb& usb) {
        speed = usb.kind() == sim::CameraKind::Usb3 ? "5000" : "480";
        descriptors = usb.deviceDescriptor();
        const auto config = usb.configDescriptor();
        descriptors.insert(descriptors.end(), config.begin(), config.end());
    });
    const std::string port = std::to_string(port_);
    const std::string device = "/devices/usb1/1-" + port;
    const std::string hid = device + "/1-" + port + ":1.0/" + hidName();
    const auto interface = [&](int number, const std::string& kind) {
        const std::string n = std::to_string(number);
        return "P: " + device + "/1-" + port + ":1." + n +
               "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\nA: bInterfaceNumber=0" + n +
               "\\n\nA: bInterfaceClass=" + kind + "\\n\n\n";
    };
    return "P: " + device + "\nN: " + usbNode().substr(5) +
           "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: DRIVER=usb\nE: BUSNUM=001\nE: DEVNUM=" +
           std::to_string(number_) + "\nE: DEVNAME=" + usbNode() +
           "\nE: PRODUCT=1209/1/100\nA: busnum=1\\n\nA: devnum=" + std::to_string(number_) +
           "\\n\nA: speed=" + speed +
           "\\n\nA: bConfigurationValue=1\\n\nA: idVendor=1209\\n\n"
           "A: idProduct=0001\\n\nA: bcdDevice=0100\\n\nA: serial=" +
           serial_ + "\\n\nA: manufacturer=gonio\\n\nA: product=simulated rig\\n\nH: descriptors=" +
           hex(descriptors) + "\n\n" + interface(0, "03") + interface(1, "ff") + "P: " + hid +
           "\nE: SUBSYSTEM=hid\nE: DRIVER=hid-generic\nE: HID_ID=0003:00001209:00000001\n"
           "E: HID_NAME=gonio simulated rig\nE: HID_PHYS=usb-1-" +
           port + "/input0\nE: HID_UNIQ=" + serial_ +
           "\nA: uevent=HID_ID=0003:00001209:00000001\\n" +
           "HID_NAME=gonio simulated rig\\nHID_PHYS=usb-1-" + port +
           "/input0\\nHID_UNIQ=" + serial_ +
           "\\n\nH: report_descriptor=" + hex(sim::usb::reportDescriptor()) + "\n\nP: " + hid +
           "/hidraw" + hidNode().substr(4) + "\nN: " + hidNode().substr(5) +
           "\nE: SUBSYSTEM=hidraw\nE: DEVNAME=" + hidNode() + "\nL: device=../../../" + hidName() +
           "\n\n";
}

void MockRig::plug() {
    const std::scoped_lock lock(mutex_);
    live_.with([](sim::FaultyUsb& usb) {
        if (!usb.plugged()) usb.plug();
    });
    if (!usbfs_) putUp();
}

void MockRig::sendInstead(std::deque<sim::UsbReply> transfers) {
    const std::scoped_lock lock(mutex_);
    usbfs_->sendInstead(std::move(transfers));
}

void MockRig::spoilFeatures(int reports) {
    const std::scoped_lock lock(mutex_);
    hidraw_->spoilFeatures(reports);
}

void MockRig::resetsFor(std::chrono::milliseconds patience) {
    const std::scoped_lock lock(mutex_);
    usbfs_->resetsFor(patience);
}

void MockRig::unplug() {
    const std::scoped_lock lock(mutex_);
    live_.with([](sim::FaultyUsb& usb) { usb.unplug(); });
    if (usbfs_) takeDown(false);
}

void MockRig::unplug(const std::function<void()>& meanwhile) {
    const std::scoped_lock lock(mutex_);
    usbfs_->sendInstead({});
    live_.with([](sim::FaultyUsb& usb) { usb.unplug(); });
    meanwhile();
    takeDown(false);
}

void MockRig::forgetPulled() {
    const std::scoped_lock lock(mutex_);
    pulled_.clear();
}

/// What a script does to the cable happens to the nodes.
void MockRig::watchTheCable() {
    const std::scoped_lock lock(mutex_);
    bool plugged = false, quietly = false;
    int pulls = 0;
    live_.with([&](sim::FaultyUsb& usb) {
        plugged = usb.plugged();
        quietly = usb.quietlyPulled();
        pulls = usb.pulls();
    });
    if (usbfs_ && (!plugged || pulls != pulls_)) takeDown(quietly);
    if (!usbfs_ && plugged) putUp();
    if (hidraw_) hidraw_->clearHalt();
    for (const auto& node : pulled_) node->settle();
}

void MockRig::putUp() {
    // Upwards, and from the start again; three digits, as the node's name has them. Ports do not
    // meet.
    constexpr int kPorts = 8, kFirst = 100, kMost = 255;
    number_ = number_ == 0 || number_ + kPorts > kMost ? kFirst + port_ : number_ + kPorts;
    hidNumber_ = hidNumber_ == 0 ? kFirst + port_ : hidNumber_ + kPorts;  // never the same again
    live_.with([this](sim::FaultyUsb& usb) {
        serial_ = usb.usb().device().serial();
        pulls_ = usb.pulls();
    });
    usbfs_ = std::make_unique<UsbfsNode>(live_, bus_.testbed(), usbNode());
    hidraw_ = std::make_unique<HidrawNode>(live_, bus_.testbed(), hidNode());
    GError* error = nullptr;
    const std::scoped_lock lock(bus_.listeners());
    if (!umockdev_testbed_add_from_string(bus_.testbed(), description().c_str(), &error)) {
        const std::string why = error->message;
        g_error_free(error);
        throw std::runtime_error(why);
    }
    hidraw_->connect();
}

void MockRig::takeDown(bool quietly) {
    usbfs_->pull(quietly);
    hidraw_->pull(quietly);
    const std::string port = std::to_string(port_);
    const std::string device = "/sys/devices/usb1/1-" + port;
    const std::string interface = device + "/1-" + port + ":1.";
    const std::scoped_lock lock(bus_.listeners());
    for (const std::string& path : {interface + "0/" + hidName() + "/hidraw" + hidNode().substr(4),
                                    interface + "0/" + hidName(),
                                    interface + "0",
                                    interface + "1",
                                    device}) {
        umockdev_testbed_uevent(bus_.testbed(), path.c_str(), "remove");
        umockdev_testbed_remove_device(bus_.testbed(), path.c_str());
    }
    // umockdev leaves the nodes of a removed device behind.
    unlink(bus_.real(usbNode()).c_str());
    unlink(bus_.real(hidNode()).c_str());
    pulled_.push_back(std::move(usbfs_));
    pulled_.push_back(std::move(hidraw_));
}

}  // namespace gonio::device_test
