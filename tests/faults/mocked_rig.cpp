#include "tests/faults/mocked_rig.h"

#include <thread>

#include "driver/usb_ledger.h"
#include "driver/usb_transport.h"
#include "tests/device/mock_bus.h"
#include "tests/support/wait_until.h"

namespace gonio::fault_test {
namespace {

class MockedRig : public RigDoor {
public:
    explicit MockedRig(const RigSetup& setup) : rig_(bus_, setup.config) {
        rig_.live().with([](sim::FaultyUsb& usb) { placeSample(usb.device()); });
        rig_.live().warmUp(setup.window);
    }
    Result<driver::Transport*> open() override {
        close();
        rig_.settle();
        const std::scoped_lock lock(bus_.listeners());
        auto opened = driver::openUsb();
        if (!opened) return opened.error();
        transport_ = std::move(*opened);
        return transport_.get();
    }
    void close() override {
        {
            const std::scoped_lock lock(bus_.listeners());
            transport_.reset();
        }
        // On a busy machine closing may take longer than the driver waits for it.
        const auto& ledger = driver::usbLedger();
        (void)test::waitUntil([&] { return ledger.streams == 0 && ledger.hidThreads == 0; });
        rig_.forgetPulled();
    }
    [[nodiscard]] Ring ring() override {
        const driver::UsbLedger& ledger = driver::usbLedger();
        return {.allowed = ledger.transfersAllowed, .inFlight = ledger.transfersInFlight};
    }
    [[nodiscard]] int slack() const override { return 10; }
    void pause(Nanoseconds time) override { std::this_thread::sleep_for(time); }
    void with(const std::function<void(sim::FaultyUsb&)>& use) override { rig_.live().with(use); }

private:
    device_test::MockBus bus_;
    device_test::MockRig rig_;
    std::unique_ptr<driver::Transport> transport_;
};

}  // namespace

std::unique_ptr<RigDoor> mocked(const RigSetup& setup) {
    return std::make_unique<MockedRig>(setup);
}

}  // namespace gonio::fault_test
