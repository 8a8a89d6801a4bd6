#include "tests/device/hidraw_node.h"

#include <fcntl.h>
#include <linux/hidraw.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <thread>

namespace gonio::device_test {
namespace {

using namespace std::chrono_literals;

// A control request of usbhid ends by itself, later than the driver waits. (A kernel waits for five
// seconds, but serves other nodes meanwhile; here one thread serves them all.)
constexpr auto kKernelPatience = 1200ms;

const sim::UsbReply kRefused{.answer = sim::UsbAnswer::Stall, .data = {}};
// The queue of 63 that hidraw has, and what it loses, is in the rig (sim/notices.h), where it is
// counted: more than that never waits here but where the reader sleeps.
constexpr int kReportsKept = 512;

/// What nobody has read must not meet the next one who opens the node.
void discardUnread(int pipe) {
    std::array<char, 4096> bytes{};
    while (::read(pipe, bytes.data(), bytes.size()) > 0) {
    }
}

/// A pipe in the place of the terminal that umockdev has made.
int makePipe(UMockdevTestbed* testbed, const std::string& path) {
    gchar* root = umockdev_testbed_get_root_dir(testbed);
    const std::string node = root + path;
    g_free(root);
    ::unlink(node.c_str());
    if (::mkfifo(node.c_str(), 0600) != 0) throw std::runtime_error("no pipe at " + node);
    const int pipe = ::open(node.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (pipe < 0) throw std::runtime_error("cannot open " + node);
    return pipe;
}

}  // namespace

HidrawNode::HidrawNode(sim::LiveRig& live, UMockdevTestbed* testbed, std::string path)
    : MockNode(live, testbed, std::move(path)) {
    g_signal_connect(handler(), "handle-ioctl", G_CALLBACK(onIoctl), this);
    g_signal_connect(handler(), "handle-write", G_CALLBACK(onWrite), this);
}

HidrawNode::~HidrawNode() {
    retire();
    if (pipe_ >= 0) ::close(pipe_);
}

void HidrawNode::connect() {
    pipe_ = makePipe(testbed(), path());
    keepsOpen(1);
    live().listen([this](const std::vector<std::uint8_t>& report) {
        if (report.empty()) {
            halted_ = true;
            return;
        }
        int unread = 0;
        const std::scoped_lock whole(writing_);
        const int most = kReportsKept * static_cast<int>(report.size());
        if (!isOpen() || ioctl(pipe_, FIONREAD, &unread) != 0 || unread >= most) return;
        (void)!::write(pipe_, report.data(), report.size());
    });
}

void HidrawNode::clearHalt() {
    constexpr sim::UsbSetup kClear{.requestType = 2, .request = 1, .index = sim::usb::kInterruptIn};
    if (halted_.exchange(false))
        live().with([&](sim::FaultyUsb& usb) { (void)usb.control(kClear); });
}

void HidrawNode::pull(bool quietly) {
    live().listen({});
    MockNode::pull(quietly);
}

void HidrawNode::firstOpened() {
    {
        const std::scoped_lock whole(writing_);
        discardUnread(pipe_);
    }
    live().with([](sim::FaultyUsb& usb) { usb.reportsOpened(); });
}

gboolean HidrawNode::onIoctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, HidrawNode* self) {
    const int result = self->answer(umockdev_ioctl_client_get_request(client),
                                    umockdev_ioctl_client_get_arg(client));
    umockdev_ioctl_client_complete(client, result < 0 ? -1 : result, result < 0 ? -result : 0);
    return TRUE;
}

gboolean HidrawNode::onWrite(UMockdevIoctlBase*, UMockdevIoctlClient* client, HidrawNode* self) {
    const UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
    const std::span report(arg->data, static_cast<std::size_t>(arg->data_len));
    int error = self->waitWhileHung(kKernelPatience);
    if (error == 0) {
        const auto reply = self->live().with([&](sim::FaultyUsb& usb) {
            return self->isAnothers(usb) ? kRefused : usb.interruptOut(report);
        });
        if (reply.answer != sim::UsbAnswer::Done) error = EPIPE;
    }
    umockdev_ioctl_client_complete(client, error == 0 ? arg->data_len : -1, error);
    return TRUE;
}

int HidrawNode::answer(unsigned long request, UMockdevIoctlData* arg) {
    if (gone()) return -ENODEV;
    const std::size_t size = _IOC_SIZE(request);
    UMockdevIoctlData* data = umockdev_ioctl_data_resolve(arg, 0, size, nullptr);
    if (!data) return -EFAULT;
    const std::span bytes(data->data, size);
    umockdev_ioctl_data_unref(data);  // its parent keeps it
    const auto descriptor = sim::usb::reportDescriptor();
    switch (_IOC_NR(request)) {
        case _IOC_NR(HIDIOCGRDESCSIZE):
            *reinterpret_cast<int*>(bytes.data()) = static_cast<int>(descriptor.size());
            return 0;
        case _IOC_NR(HIDIOCGRDESC): {
            auto& told = *reinterpret_cast<hidraw_report_descriptor*>(bytes.data());
            std::copy(descriptor.begin(), descriptor.end(), told.value);
            return 0;
        }
        case _IOC_NR(HIDIOCGRAWINFO):
            *reinterpret_cast<hidraw_devinfo*>(bytes.data()) = {BUS_USB, 0x1209, 0x0001};
            return 0;
        case _IOC_NR(HIDIOCSFEATURE(0)): return feature(false, bytes);
        case _IOC_NR(HIDIOCGFEATURE(0)): return feature(true, bytes);
        default: return -ENOTTY;
    }
}

int HidrawNode::feature(bool get, std::span<std::uint8_t> report) {
    if (const int error = waitWhileHung(kKernelPatience); error != 0) return -error;
    constexpr std::uint16_t kFeature = 3 << 8;
    const sim::UsbSetup setup{.requestType = static_cast<std::uint8_t>(get ? 0xA1 : 0x21),
                              .request = static_cast<std::uint8_t>(get ? 1 : 9),
                              .value = static_cast<std::uint16_t>(kFeature | report[0]),
                              .index = sim::UsbDevice::kHidInterface,
                              .length = static_cast<std::uint16_t>(report.size())};
    const auto reply = live().with([&](sim::FaultyUsb& usb) {
        if (isAnothers(usb)) return kRefused;
        return get ? usb.control(setup) : usb.control(setup, report);
    });
    if (reply.answer != sim::UsbAnswer::Done) return -EPIPE;
    std::copy(reply.data.begin(), reply.data.end(), report.begin());
    if (get && toSpoil_ > 0) {
        --toSpoil_;
        report.back() ^= 1;
    }
    return get ? static_cast<int>(reply.data.size()) : static_cast<int>(report.size());
}

}  // namespace gonio::device_test
