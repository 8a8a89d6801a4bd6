#include "sim/vhci_cable.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

#include "proc/core/log.h"
#include "sim/usbip_line.h"
#include "sim/usbip_server.h"

namespace gonio::sim {
namespace {

constexpr const char* kFolder = "/sys/devices/platform/vhci_hcd.0";
constexpr std::chrono::milliseconds kLook{10};
constexpr std::chrono::milliseconds kAgain{200};  // after the kernel has refused it
constexpr unsigned kFree = 4;                     // VDEV_ST_NULL of the kernel

std::string why(int error) { return std::generic_category().message(error); }

Result<unsigned> freePort(bool super) {
    std::ifstream in(vhciFolder() / "status");
    if (!in) {
        return Error{ErrorKind::NoRig,
                     "vhci: " + vhciFolder().string() +
                         " is not there: load the module, `modprobe vhci-hcd`, as root"};
    }
    const std::string status(std::istreambuf_iterator<char>(in), {});
    const auto port = freeVhciPort(status, super ? "ss" : "hs");
    if (port) return *port;
    return Error{ErrorKind::Busy,
                 "vhci: no free port: detach a rig, `usbip port` says which are attached"};
}

/// `text` to a file of sysfs, in one write.
Result<void> writeOnce(const std::filesystem::path& file, const std::string& text) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) {
        return Error{ErrorKind::Busy,
                     "vhci: " + file.string() + ": " + why(errno) + ": attaching wants root"};
    }
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    const int error = errno;
    ::close(descriptor);
    if (written == static_cast<ssize_t>(text.size())) return {};
    return Error{ErrorKind::Busy, "vhci: attach " + text + ": " + why(error)};
}

/// Another program may take the free port first: then the next one.
Result<void> attachToFreePort(const usbip::Exported& rig, int socket) {
    constexpr int kTries = 4;
    for (int tries = 1;; ++tries) {
        const auto port = freePort(rig.speed == usbip::Speed::Super);
        if (!port) return port.error();
        const auto attached = writeOnce(vhciFolder() / "attach",
                                        std::to_string(*port) + " " + std::to_string(socket) + " " +
                                            std::to_string(rig.bus << 16 | rig.number) + " " +
                                            std::to_string(static_cast<unsigned>(rig.speed)));
        if (attached || tries == kTries) return attached;
    }
}

}  // namespace

std::filesystem::path vhciFolder() { return kFolder; }

std::optional<unsigned> freeVhciPort(const std::string& status, const std::string& speed) {
    std::istringstream lines(status);
    std::string line;
    while (std::getline(lines, line)) {
        std::istringstream words(line);
        std::string hub;
        unsigned port = 0, state = 0;
        if (words >> hub >> port >> state && hub == speed && state == kFree) return port;
    }
    return std::nullopt;
}

struct VhciCable::Line {
    Line(LiveRig& rig, StreamSocket ours, int pulls) : socket(std::move(ours)) {
        thread = std::jthread([this, &rig, pulls](const std::stop_token& stop) {
            {
                UsbipLine line(rig, socket, {}, pulls);
                (void)line.serve(stop);
            }  // it resets the rig and no longer listens before there is another line
            shutdown(socket.descriptor(), SHUT_RDWR);  // the kernel sees the cable pulled now
            ended = true;
        });
    }
    StreamSocket socket;
    std::atomic<bool> ended{false};
    std::jthread thread;
};

VhciCable::VhciCable(LiveRig& rig, unsigned number) : rig_(rig), number_(number) {}

VhciCable::~VhciCable() = default;

Result<std::unique_ptr<VhciCable>> VhciCable::attach(LiveRig& rig, unsigned number) {
    std::unique_ptr<VhciCable> cable(new VhciCable(rig, number));
    if (const std::optional<int> pulls = cable->pullsIfPlugged()) {
        if (auto plugged = cable->plug(*pulls); !plugged) return plugged.error();
    }
    cable->follower_ =
        std::jthread([&one = *cable](const std::stop_token& stop) { one.follow(stop); });
    return cable;
}

void VhciCable::follow(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        std::this_thread::sleep_for(obstacle_.empty() ? kLook : kAgain);
        if (line_ && !line_->ended) continue;
        // A rig that the kernel has let go of by itself is not attached again until it is plugged.
        const std::optional<int> pulls = pullsIfPlugged();
        if (!pulls || *pulls == pulls_) continue;
        const auto plugged = plug(*pulls);
        const std::string obstacle = plugged ? "" : plugged.error().message;
        if (!obstacle.empty() && obstacle != obstacle_) log::warning(obstacle);
        obstacle_ = obstacle;
    }
}

/// How often it has been pulled, where it is plugged now.
std::optional<int> VhciCable::pullsIfPlugged() {
    return rig_.with([](FaultyUsb& usb) {
        return usb.plugged() ? std::optional<int>(usb.pulls()) : std::nullopt;
    });
}

/// A rig that was pulled meanwhile ends the line at once, and is plugged when it is back.
Result<void> VhciCable::plug(int pulls) {
    line_.reset();
    const usbip::Exported rig = exported(rig_, number_);
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
        return Error{ErrorKind::Internal, "vhci: socketpair: " + why(errno)};
    StreamSocket ours(ends[0]);
    const auto attached = attachToFreePort(rig, ends[1]);
    ::close(ends[1]);  // the kernel has it
    if (!attached) return attached;
    line_ = std::make_unique<Line>(rig_, std::move(ours), pulls);
    pulls_ = pulls;
    return {};
}

}  // namespace gonio::sim
