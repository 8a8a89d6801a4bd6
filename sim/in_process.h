#pragma once
// The in-process door: the driver's transport on a simulated device, in virtual time. Each call
// costs what it would on USB (a control or interrupt transfer 0.2 ms, bulk what the rig's camera
// kind carries), and waiting lets the virtual clock run to the next thing that happens. Every byte
// passes the codec on both sides. What the bus and the rig do wrong is in the FaultyUsb behind it;
// here it is met as the real transport meets it (driver/usb_stream.h): a stall is cleared, an error
// probed, the third in ten seconds is a failure, and so is no memory for a single transfer for
// kMemoryLimit (protocol/fault_limit.h). A failure is final, as is a port reset, and a rig that was
// unplugged is lost to this door for good: openAgain() makes another one.

#include <memory>
#include <optional>
#include <vector>

#include "driver/protocol/fault_limit.h"
#include "driver/protocol/transport.h"
#include "sim/faults/faulty_usb.h"

namespace gonio::sim {

class InProcessDoor : public driver::Transport, private Clock {
public:
    /// What the stream had to cope with since it was opened.
    struct Counters {
        int stalls = 0;
        int overflows = 0;
        int errors = 0;
        int ring = 8;      ///< transfers that may be in flight
        int inFlight = 0;  ///< as the system has memory
    };

    explicit InProcessDoor(DeviceConfig config);
    /// The rig that is at the plug, whichever it is now; a NoRig error when there is none, and a
    /// Device error when there is no memory for any transfer.
    [[nodiscard]] Result<std::unique_ptr<InProcessDoor>> openAgain() const;

    [[nodiscard]] driver::DeviceStrings strings() const override { return strings_; }
    [[nodiscard]] const Clock& clock() const override { return *this; }
    Result<void> write(const driver::Report& report) override;
    Result<void> setFeature(const driver::Report& report) override;
    [[nodiscard]] Result<driver::Report> getFeature(std::uint8_t id) override;
    [[nodiscard]] Result<std::optional<driver::Report>> readInput(Nanoseconds wait) override;
    [[nodiscard]] Result<std::optional<driver::BulkBytes>> readBulk(Nanoseconds wait) override;
    Result<void> reopenReports() override;
    Result<void> resetPort() override;

    [[nodiscard]] Device& device() { return usb_->device(); }
    /// The bus and the cable, and what goes wrong there.
    [[nodiscard]] FaultyUsb& usb() { return *usb_; }
    [[nodiscard]] const Counters& counters() const { return counters_; }

private:
    /// Shared: doors that were opened one after the other are doors to one rig.
    explicit InProcessDoor(std::shared_ptr<FaultyUsb> usb, int pulls);
    [[nodiscard]] Nanoseconds now() const override { return usb_->now(); }
    void spend(Nanoseconds time) { usb_->advanceTo(now() + time); }
    /// False: `deadline` has come.
    bool pass(Nanoseconds deadline);
    [[nodiscard]] std::string stringOf(std::uint8_t index);
    [[nodiscard]] Result<void> there();
    [[nodiscard]] Error fail(const std::string& what);
    /// Asks until the rig says something else than NAK, a second at most.
    template <class Ask>
    Result<UsbReply> request(const std::string& what, Ask ask);
    Result<void> recover(UsbAnswer answer);
    Result<void> fillRing();

    std::shared_ptr<FaultyUsb> usb_;
    int pulls_;
    driver::DeviceStrings strings_;
    std::vector<std::uint8_t> lent_;
    Counters counters_;
    driver::FaultLimit limit_;
    std::optional<Error> failure_;
    std::optional<Nanoseconds> starvedSince_;  ///< no memory for any transfer
    bool warned_ = false;
};

}  // namespace gonio::sim
