#include "tests/device/mock_node.h"

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <thread>
#include <utility>

namespace gonio::device_test {

using namespace std::chrono_literals;

MockNode::MockNode(sim::LiveRig& live, UMockdevTestbed* testbed, std::string path)
    : live_(live),
      pulls_(live.with([](sim::FaultyUsb& usb) { return usb.pulls(); })),
      testbed_(testbed),
      path_(std::move(path)),
      handler_(umockdev_ioctl_base_new()) {
    g_signal_connect(handler_, "client-connected", G_CALLBACK(onOpen), this);
    umockdev_testbed_attach_ioctl(testbed_, path_.c_str(), handler_, nullptr);
}

MockNode::~MockNode() { g_object_unref(handler_); }

void MockNode::retire() {
    const auto end = std::chrono::steady_clock::now() + 1s;
    while (isOpen() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(1ms);
    if (!gone_) pull(false);
    detach();
    g_signal_handlers_disconnect_by_data(handler_, this);
}

void MockNode::pull(bool /*quietly*/) {
    gone_ = true;
    pulledAt_ = std::chrono::steady_clock::now();
}

void MockNode::settle() {
    constexpr auto kOpening = 100ms;  // whoever was about to open it when it vanished
    if (gone_ && std::chrono::steady_clock::now() - pulledAt_ > kOpening) detach();
}

void MockNode::detach() {
    if (!std::exchange(detached_, true))
        umockdev_testbed_detach_ioctl(testbed_, path_.c_str(), nullptr);
}

bool MockNode::hung() const {
    return live_.faults.hung || live_.with([](sim::FaultyUsb& usb) { return usb.hung(); });
}

int MockNode::waitWhileHung(std::chrono::milliseconds patience) const {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (hung() && !gone() && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(5ms);
    return gone() ? ENODEV : hung() ? ETIMEDOUT : 0;
}

/// Nobody is told when a client goes: one has to look.
bool MockNode::isOpen() {
    const std::scoped_lock lock(mutex_);
    std::erase_if(clients_, [](UMockdevIoctlClient* client) {
        if (umockdev_ioctl_client_get_connected(client)) return false;
        g_object_unref(client);
        return true;
    });
    return !clients_.empty();
}

/// One who closed it a moment ago may still look connected. The files of all processes do not lie.
bool MockNode::isOpenedAlone() const {
    namespace fs = std::filesystem;
    std::error_code gone;
    gchar* root = umockdev_testbed_get_root_dir(testbed_);
    const fs::path node = fs::canonical(std::string(root) + path_, gone);
    g_free(root);
    int files = 0;
    for (const auto& process : fs::directory_iterator("/proc", gone)) {
        if (process.path().filename().string().find_first_not_of("0123456789") != std::string::npos)
            continue;                // no process, or this one under another name
        std::error_code unreadable;  // it has ended
        for (const auto& file : fs::directory_iterator(process.path() / "fd", unreadable))
            files += fs::read_symlink(file.path(), unreadable) == node ? 1 : 0;
    }
    return files <= 1 + ownFiles_;
}

void MockNode::onOpen(UMockdevIoctlBase*, UMockdevIoctlClient* client, MockNode* self) {
    if (!self->isOpen() || self->isOpenedAlone()) self->firstOpened();
    const std::scoped_lock lock(self->mutex_);
    self->clients_.push_back(UMOCKDEV_IOCTL_CLIENT(g_object_ref(client)));
}

}  // namespace gonio::device_test
