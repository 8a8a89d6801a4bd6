#pragma once
// /dev/hidrawN: reports of a simulated rig. The node is a pseudo terminal, so that poll() works:
// input reports are written into its other end while somebody has it open, as a kernel queues them
// per open file.

#include <umockdev.h>

#include <atomic>
#include <string>

#include "tests/device/live_rig.h"

namespace gonio::device_test {

class HidrawNode {
public:
    HidrawNode(LiveRig& live, UMockdevTestbed* testbed, std::string path);
    ~HidrawNode();
    HidrawNode(const HidrawNode&) = delete;
    HidrawNode& operator=(const HidrawNode&) = delete;
    /// Call once the test bed has the node.
    void connect();
    /// From now on the device is gone.
    void pull();

private:
    static void onOpen(UMockdevIoctlBase*, UMockdevIoctlClient* client, HidrawNode* self);
    static void onClose(UMockdevIoctlClient* client, GParamSpec*, HidrawNode* self);
    static gboolean onIoctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, HidrawNode* self);
    static gboolean onWrite(UMockdevIoctlBase*, UMockdevIoctlClient* client, HidrawNode* self);
    /// Bytes moved, or minus the errno.
    int answer(unsigned long request, UMockdevIoctlData* arg);
    int feature(bool get, std::span<std::uint8_t> report);
    void waitWhileHung() const;

    LiveRig& live_;
    UMockdevTestbed* testbed_;
    std::string path_;
    UMockdevIoctlBase* handler_;
    int terminal_ = -1;
    std::atomic<int> openFiles_{0};
    std::atomic<bool> gone_{false};
};

}  // namespace gonio::device_test
