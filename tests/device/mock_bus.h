#pragma once
// The umockdev test bed with rigs on it: sysfs, udev and the device nodes that libusb, hidapi and
// libudev see, answered by simulated rigs in real time. One bus at a time in a process, and the
// process must run under umockdev-wrapper. Transports are closed before their rig and bus end.

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "sim/live_rig.h"

typedef struct _UMockdevTestbed UMockdevTestbed;

namespace gonio::device_test {

class HidrawNode;
class MockNode;
class UsbfsNode;

/// As descriptions of devices have bytes: "0A1F".
[[nodiscard]] std::string hex(std::span<const std::uint8_t> bytes);

class MockBus {
public:
    MockBus();
    ~MockBus();
    MockBus(const MockBus&) = delete;
    MockBus& operator=(const MockBus&) = delete;
    [[nodiscard]] UMockdevTestbed* testbed() const { return testbed_; }
    /// Where a path of the mocked system is in truth.
    [[nodiscard]] std::string real(const std::string& path) const;
    /// umockdev ends the process when it tells a listener to udev that is just closing. Rigs that
    /// come and go hold this, and so does whoever opens or closes a transport meanwhile.
    [[nodiscard]] std::mutex& listeners() { return listeners_; }

private:
    UMockdevTestbed* testbed_;
    std::mutex listeners_;
};

class MockRig {
public:
    /// Plugged in at `port`.
    MockRig(MockBus& bus, sim::DeviceConfig config, int port = 1);
    ~MockRig();
    MockRig(const MockRig&) = delete;
    MockRig& operator=(const MockRig&) = delete;

    void plug();
    /// The cable is pulled: transfers in flight end in errors, then the nodes vanish. A fault
    /// script pulls it too.
    void unplug();
    /// Likewise, but the transfers in flight end, and the nodes vanish, only when `meanwhile` is
    /// over: until then every request fails.
    void unplug(const std::function<void()>& meanwhile);
    /// The stream brings these transfers and then none, whatever the rig has.
    void sendInstead(std::deque<sim::UsbReply> transfers);
    /// Of the nodes that it has now: the next feature reports that are read arrive damaged; as long
    /// as it hangs, a kernel tries to reset its port for so long.
    void spoilFeatures(int reports);
    void resetsFor(std::chrono::milliseconds patience);
    /// What a script has done to the cable by now has happened to the nodes.
    void settle() { watchTheCable(); }
    /// Those who had the pulled nodes open have closed them.
    void forgetPulled();
    [[nodiscard]] sim::LiveRig& live() { return live_; }
    [[nodiscard]] sim::Faults& faults() { return live_.faults; }
    [[nodiscard]] std::string usbNode() const;
    [[nodiscard]] std::string hidNode() const;

private:
    [[nodiscard]] std::string description();
    void watchTheCable();
    // With the mutex held:
    void putUp();
    void takeDown(bool quietly);
    [[nodiscard]] std::string hidName() const;

    MockBus& bus_;
    sim::LiveRig live_;
    mutable std::mutex mutex_;  ///< of what follows
    std::string serial_;
    int port_;
    int pulls_ = 0;      ///< of the rig's cable when the nodes were made
    int number_ = 0;     ///< of its usbfs node: another one each time it is plugged in
    int hidNumber_ = 0;  ///< of its hidraw node
    std::vector<std::unique_ptr<MockNode>> pulled_;  ///< still open to those who had them
    std::unique_ptr<UsbfsNode> usbfs_;
    std::unique_ptr<HidrawNode> hidraw_;
    std::jthread hand_;  ///< on the cable
};

}  // namespace gonio::device_test
