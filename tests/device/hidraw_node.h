#pragma once
// /dev/hidrawN: reports of a simulated rig. The node is a pipe, so that poll() works and reports
// stay whole, however late they are read (a terminal, which umockdev makes, hands out part of one
// once 64 are unread): input reports are written into it while somebody has it open, as a kernel
// queues them per open file.

#include <atomic>
#include <mutex>
#include <string>

#include "sim/live_rig.h"
#include "tests/device/mock_node.h"

namespace gonio::device_test {

class HidrawNode : public MockNode {
public:
    HidrawNode(sim::LiveRig& live, UMockdevTestbed* testbed, std::string path);
    ~HidrawNode() override;
    /// Call once the test bed has the node.
    void connect();
    void pull(bool quietly) override;
    /// The next feature reports that are read arrive damaged.
    void spoilFeatures(int reports) { toSpoil_ = reports; }
    /// As usbhid does: the halt of a stalled endpoint is cleared. Not from within the rig.
    void clearHalt();

private:
    void firstOpened() override;
    static gboolean onIoctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, HidrawNode* self);
    static gboolean onWrite(UMockdevIoctlBase*, UMockdevIoctlClient* client, HidrawNode* self);
    /// Bytes moved, or minus the errno.
    int answer(unsigned long request, UMockdevIoctlData* arg);
    int feature(bool get, std::span<std::uint8_t> report);

    int pipe_ = -1;
    std::atomic<bool> halted_{false};
    std::atomic<int> toSpoil_{0};
    std::mutex writing_;  ///< reports go into it whole
};

}  // namespace gonio::device_test
