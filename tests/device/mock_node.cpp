#include "tests/device/mock_node.h"

#include <chrono>
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

void MockNode::onOpen(UMockdevIoctlBase*, UMockdevIoctlClient* client, MockNode* self) {
    if (!self->isOpen()) self->firstOpened();
    self->opened();
    const std::scoped_lock lock(self->mutex_);
    self->clients_.push_back(UMOCKDEV_IOCTL_CLIENT(g_object_ref(client)));
}

}  // namespace gonio::device_test
