#include "tests/guest/cabled_door.h"

#include <algorithm>
#include <stdexcept>
#include <thread>

#include "driver/usb_ledger.h"
#include "driver/usb_transport.h"
#include "sim/vhci_cable.h"
#include "tests/support/wait_until.h"

namespace gonio::guest_test {
namespace {

// An emulated processor has better to do than to look at all devices again and again.
constexpr std::chrono::milliseconds kLook{50};

class CabledDoor : public fault_test::RigDoor {
public:
    explicit CabledDoor(const fault_test::RigSetup& setup)
        : wanted_{.serial = setup.config.serial}, live_(setup.config) {
        live_.with([](sim::FaultyUsb& usb) { fault_test::placeSample(usb.device()); });
        live_.warmUp(setup.window);
        auto attached = sim::VhciCable::attach(live_);
        if (!attached) throw std::runtime_error(attached.error().message);
        cable_ = std::move(*attached);
        // The kernel makes the nodes one after the other.
        (void)test::waitUntil(
            [&] { return driver::openUsb(wanted_).has_value(); }, test::kPatience, kLook);
    }
    ~CabledDoor() override {
        transport_.reset();
        cable_.reset();
        (void)test::waitUntil(
            [&] {
                const auto rigs = driver::listUsb(wanted_);
                return rigs && rigs->empty();
            },
            test::kPatience,
            kLook);
    }
    CabledDoor(const CabledDoor&) = delete;
    CabledDoor& operator=(const CabledDoor&) = delete;

    Result<driver::Transport*> open() override {
        transport_.reset();
        auto opened = driver::openUsb(wanted_);
        if (!opened) return opened.error();
        transport_ = std::move(*opened);
        return transport_.get();
    }
    void close() override { transport_.reset(); }
    [[nodiscard]] Ring ring() override {
        const driver::UsbLedger& ledger = driver::usbLedger();
        return {.allowed = ledger.transfersAllowed, .inFlight = ledger.transfersInFlight};
    }
    [[nodiscard]] int slack() const override { return 10; }  // an emulated machine
    void pause(Nanoseconds time) override {
        std::this_thread::sleep_for(std::max<Nanoseconds>(time, 5 * kLook));
    }
    void with(const std::function<void(sim::FaultyUsb&)>& use) override { live_.with(use); }

private:
    driver::UsbSelection wanted_;  // the daemon has a rig beside it
    sim::LiveRig live_;
    std::unique_ptr<sim::VhciCable> cable_;
    std::unique_ptr<driver::Transport> transport_;
};

}  // namespace

std::unique_ptr<fault_test::RigDoor> cabled(const fault_test::RigSetup& setup) {
    return std::make_unique<CabledDoor>(setup);
}

}  // namespace gonio::guest_test
