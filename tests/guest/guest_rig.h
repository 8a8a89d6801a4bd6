#pragma once
// A simulated rig on the real USB of the guest's kernel: the cable is vhci-hcd's, and all above it
// is what a real rig meets: usbcore, usbfs, usbhid, hidraw, libusb and hidapi.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "driver/rig.h"
#include "driver/usb_transport.h"
#include "proc/models/spec.h"
#include "sim/in_process.h"
#include "sim/vhci_cable.h"
#include "tests/support/wait_until.h"

namespace gonio::guest_test {

using namespace std::chrono_literals;

// Not the only rig in the guest: the daemon has one of its own (measure.sh). Each test names its.
inline constexpr const char* kSerial = "SIM-0042";
inline constexpr const char* kOtherSerial = "SIM-0043";
inline constexpr std::uint64_t kSession = 0x1122334455667788;
inline constexpr Window kSmallWindow{.x = 512, .y = 384, .size = {128, 128}, .binning = 1};
/// The guest's processors are emulated, and others want the host's.
inline constexpr auto kPatience = 20s;

inline sim::DeviceConfig rigConfig(std::uint32_t bootCount = 1) {
    return {.serial = kSerial, .seed = 11, .bootCount = bootCount, .errors = {}};
}

inline void placeMattGrey(sim::Device& device) {
    device.place({.role = sim::Role::Sample,
                  .surface = std::move(*proc::makeModel("lambert,albedo=0.5")),
                  .wedge = {}});
}

inline Result<std::unique_ptr<driver::Transport>> openRig() {
    return driver::openUsb({.serial = kSerial});
}

/// Those that the tests have plugged in.
inline std::vector<driver::UsbRig> ownRigs() {
    std::vector<driver::UsbRig> own;
    for (const char* serial : {kSerial, kOtherSerial}) {
        const auto rigs = driver::listUsb({.serial = serial});
        if (rigs) own.insert(own.end(), rigs->begin(), rigs->end());
    }
    return own;
}

/// Another step of the plan each time: one session serves all tests.
inline driver::CaptureRequest litFrames(int frames = 1) {
    static std::uint64_t step = 0;
    return {.planStep = ++step,
            .led = 1,
            .levels = LedLevels::only(Band::G, 65535),
            .exposure = Microseconds(320),
            .frames = frames};
}

/// A rig and the cable it hangs on, which the kernel lets go of when this ends.
struct CabledRig {
    explicit CabledRig(const sim::DeviceConfig& config = rigConfig(), unsigned number = 1)
        : live(config) {
        live.with([](sim::FaultyUsb& usb) { placeMattGrey(usb.device()); });
        live.warmUp(kSmallWindow);
        auto attached = sim::VhciCable::attach(live, number);
        EXPECT_TRUE(attached) << attached.error().message;
        if (attached) cable = std::move(*attached);
    }
    void play(const std::string& script) {
        auto parsed = sim::FaultScript::parse(script);
        ASSERT_TRUE(parsed) << parsed.error().message;
        live.with([&](sim::FaultyUsb& usb) { usb.play(std::move(*parsed)); });
    }
    void unplug() {
        live.with([](sim::FaultyUsb& usb) { usb.unplug(); });
    }
    void plug() {
        live.with([](sim::FaultyUsb& usb) { usb.plug(); });
    }
    sim::LiveRig live;
    std::unique_ptr<sim::VhciCable> cable;  // before its rig
};

/// What a rig that nothing disturbs takes.
inline std::vector<Frame> undisturbed(const driver::CaptureRequest& request) {
    // One for all tests: what it works out of the scene is the costly part.
    static sim::InProcessDoor door(rigConfig());
    static std::optional<driver::Rig> twin;
    if (!twin) {
        placeMattGrey(door.device());
        auto opened = driver::Rig::open(door, kSession);
        EXPECT_TRUE(opened);
        twin.emplace(std::move(*opened));
        EXPECT_TRUE(twin->configure(kSmallWindow));
    }
    auto capture = twin->capture(request);
    EXPECT_TRUE(capture);
    return std::move(capture->frames);
}

class GuestRig : public testing::Test {
protected:
    /// The twin works out its scene before a rig waits for a heartbeat meanwhile.
    static void SetUpTestSuite() { (void)undisturbed(litFrames()); }
    void SetUp() override {
        if (!rig) rig = std::make_unique<CabledRig>();
        rig->live.with([](sim::FaultyUsb& usb) {
            usb.play({});
            if (!usb.plugged()) usb.plug();
        });
        awaitRigs(1);
    }
    void TearDown() override { close(); }
    static void TearDownTestSuite() { rig.reset(); }

    /// Until the kernel has made the nodes, and the rig can be opened.
    static void plug() {
        rig->plug();
        awaitRigs(1);
    }
    /// So many, each without an obstacle.
    static void awaitRigs(std::size_t count) {
        EXPECT_TRUE(test::waitUntil(
            [&] {
                const auto rigs = ownRigs();
                return rigs.size() == count &&
                       std::all_of(rigs.begin(), rigs.end(), [](const driver::UsbRig& one) {
                           return one.obstacle.empty();
                       });
            },
            kPatience,
            50ms))
            << "not seen: " << count << " rigs";
    }
    void open() {
        auto transport = openRig();
        ASSERT_TRUE(transport) << transport.error().message;
        transport_ = std::move(*transport);
        auto opened = driver::Rig::open(*transport_, kSession);
        ASSERT_TRUE(opened) << opened.error().message;
        driven.emplace(std::move(*opened));
        const auto configured = driven->configure(kSmallWindow);
        ASSERT_TRUE(configured) << configured.error().message;
    }
    void close() {
        driven.reset();
        transport_.reset();
    }
    /// Captures, and compares with what a rig takes that nothing disturbs.
    driver::Capture same(const driver::CaptureRequest& request) {
        auto capture = driven->capture(request);
        EXPECT_TRUE(capture) << capture.error().message;
        if (!capture) return {};
        const auto wanted = undisturbed(request);
        EXPECT_EQ(capture->size(), wanted.size());
        for (std::size_t i = 0; i < std::min(capture->size(), wanted.size()); ++i)
            EXPECT_EQ((*capture)[i].pixels, wanted[i].pixels) << "frame " << i;
        return std::move(*capture);
    }
    [[nodiscard]] driver::Transport& transport() { return *transport_; }

    static inline std::unique_ptr<CabledRig> rig;  ///< of all tests: one stays plugged
    std::optional<driver::Rig> driven;

private:
    std::unique_ptr<driver::Transport> transport_;
};

}  // namespace gonio::guest_test
