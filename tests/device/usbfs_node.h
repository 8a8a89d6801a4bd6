#pragma once
// /dev/bus/usb/...: the requests of usbfs that libusb makes, answered by a simulated rig. Bulk
// transfers wait here until the rig has something; a look for finished ones waits half a
// millisecond, since nothing else keeps libusb from asking without pause (the node is a plain file,
// which poll() always finds ready).

#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "sim/live_rig.h"
#include "tests/device/mock_node.h"

struct usbdevfs_urb;

namespace gonio::device_test {

class UsbfsNode : public MockNode {
public:
    UsbfsNode(sim::LiveRig& live, UMockdevTestbed* testbed, std::string path);
    ~UsbfsNode() override;
    void pull(bool quietly) override;
    /// From now on the stream brings these transfers, whatever the rig has, and then none.
    void sendInstead(std::deque<sim::UsbReply> transfers);
    /// So long is the port of a hung rig reset.
    void resetsFor(std::chrono::milliseconds patience);

private:
    struct Urb {
        UMockdevIoctlClient* client = nullptr;  ///< the open file that it belongs to
        UMockdevIoctlData* data = nullptr;      ///< the caller's struct usbdevfs_urb
        sim::UsbReply reply;
        int status = 0;
    };
    static gboolean onIoctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, UsbfsNode* self);
    /// The errno, 0 for success.
    int answer(UMockdevIoctlClient* client);
    int submit(UMockdevIoctlClient* client, UMockdevIoctlData* arg);
    int discard(UMockdevIoctlData* arg);
    int reap(UMockdevIoctlClient* client, UMockdevIoctlData* arg);
    int setInterface(UMockdevIoctlData* arg, std::unique_lock<std::mutex>& lock);
    int request(const sim::UsbSetup& setup, std::unique_lock<std::mutex>& lock);
    int claim(UMockdevIoctlClient* client, int interface);
    int release(UMockdevIoctlClient* client, int interface);
    [[nodiscard]] int mostTransfers();
    [[nodiscard]] bool runControl(Urb& urb);
    [[nodiscard]] bool advanceControl();
    [[nodiscard]] bool advanceBulk();
    [[nodiscard]] sim::UsbReply nextForeign();
    static void forget(std::deque<Urb>& urbs);
    void forgetTheDead();

    std::mutex mutex_;
    std::deque<Urb> controls_, waiting_;  ///< of endpoint 0, of the bulk endpoint
    std::deque<Urb> done_;
    std::map<int, UMockdevIoctlClient*> claims_;  ///< who has an interface
    std::optional<std::deque<sim::UsbReply>> foreign_;
    // A kernel asks such a rig for its descriptors again and again.
    std::chrono::milliseconds resetPatience_{1200};
};

}  // namespace gonio::device_test
