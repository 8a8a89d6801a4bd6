#pragma once
// A device node of the test bed whose requests are answered here. It outlives those who have it
// open: pulled means that it answers ENODEV, not that it is no more.

#include <umockdev.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include "sim/live_rig.h"

namespace gonio::device_test {

class MockNode {
public:
    MockNode(sim::LiveRig& live, UMockdevTestbed* testbed, std::string path);
    /// Waits until nobody has it open, one second at most.
    virtual ~MockNode();
    MockNode(const MockNode&) = delete;
    MockNode& operator=(const MockNode&) = delete;
    /// From now on the device is gone. Quietly: no transfer in flight ends in an error first.
    virtual void pull(bool quietly);
    /// Of one that was pulled a while ago, the ends that nobody can come upon any more. Not sooner:
    /// umockdev ends a process whose open() meets a socket that is just closed.
    void settle();

protected:
    [[nodiscard]] UMockdevIoctlBase* handler() const { return handler_; }
    [[nodiscard]] UMockdevTestbed* testbed() const { return testbed_; }
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] bool isOpen();
    [[nodiscard]] bool isOpenedAlone() const;
    [[nodiscard]] bool gone() const { return gone_; }
    [[nodiscard]] sim::LiveRig& live() const { return live_; }
    /// There, and answering nothing.
    [[nodiscard]] bool hung() const;
    /// As a kernel waits for an answer. 0: there is one; or the errno.
    [[nodiscard]] int waitWhileHung(std::chrono::milliseconds patience) const;
    /// Another rig is at the plug by now, or this one again: its node is another.
    [[nodiscard]] bool isAnothers(const sim::FaultyUsb& usb) const {
        return usb.plugged() && usb.pulls() != pulls_;
    }
    /// Somebody opens it that nobody else has open.
    virtual void firstOpened() {}
    /// The test bed itself has the node open so often.
    void keepsOpen(int files) { ownFiles_ = files; }
    /// A derived class calls it first thing when it ends: no request comes after it.
    void retire();

private:
    void detach();
    static void onOpen(UMockdevIoctlBase*, UMockdevIoctlClient* client, MockNode* self);

    sim::LiveRig& live_;
    int pulls_;  ///< of the cable when it was made
    UMockdevTestbed* testbed_;
    std::string path_;
    UMockdevIoctlBase* handler_;
    std::mutex mutex_;
    std::vector<UMockdevIoctlClient*> clients_;  ///< of the files that were open last time
    std::atomic<bool> gone_{false};
    int ownFiles_ = 0;
    std::chrono::steady_clock::time_point pulledAt_{};
    bool detached_ = false;
};

}  // namespace gonio::device_test
