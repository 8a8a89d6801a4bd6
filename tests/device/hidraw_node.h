#pragma once
// /dev/hidrawN: reports of a simulated rig. The node is a pseudo terminal, so that poll() works:
// input reports are written into its other end while somebody has it open, as a kernel queues them
// per open file.

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
    /// As usbhid does: the halt of a stalled endpoint is cleared. Not from within the rig.
    void clearHalt();

private:
    void firstOpened() override;
    void opened() override;
    static gboolean onIoctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, HidrawNode* self);
    static gboolean onWrite(UMockdevIoctlBase*, UMockdevIoctlClient* client, HidrawNode* self);
    /// Bytes moved, or minus the errno.
    int answer(unsigned long request, UMockdevIoctlData* arg);
    int feature(bool get, std::span<std::uint8_t> report);
    [[nodiscard]] bool hung() const;
    void waitWhileHung() const;

    sim::LiveRig& live_;
    int terminal_ = -1;
    std::atomic<bool> halted_{false};
    std::mutex writing_;  ///< reports go into it whole
};

}  // namespace gonio::device_test
