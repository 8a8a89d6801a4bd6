#pragma once
// A rig on a mocked bus, with a matt grey under it, and its twin behind the in-process door.

#include <gtest/gtest.h>

#include "driver/rig.h"
#include "driver/usb_transport.h"
#include "proc/models/spec.h"
#include "sim/in_process.h"
#include "tests/device/mock_bus.h"

namespace gonio::device_test {

inline constexpr std::uint64_t kSession = 0x1122334455667788;
inline constexpr Window kSmallWindow{.x = 512, .y = 384, .size = {256, 256}, .binning = 1};

inline sim::DeviceConfig rigConfig(const std::string& serial = "SIM-0042") {
    return {.serial = serial, .seed = 11, .bootCount = 1, .errors = {}};
}

inline sim::Placement mattGrey() {
    return {.role = sim::Role::Sample,
            .surface = std::move(*proc::makeModel("lambert,albedo=0.5")),
            .wedge = {}};
}

class UsbRigTest : public testing::Test {
protected:
    explicit UsbRigTest(const sim::DeviceConfig& config = rigConfig()) : mock(bus, config) {
        mock.live().with([](sim::FaultyUsb& usb) { usb.device().place(mattGrey()); });
    }
    /// The transport, or a failed test.
    [[nodiscard]] std::unique_ptr<driver::Transport> opened() {
        auto transport = driver::openUsb();
        EXPECT_TRUE(transport) << transport.error().message;
        return transport ? std::move(*transport) : nullptr;
    }

    MockBus bus;
    MockRig mock;
};

inline driver::CaptureRequest litFrames(std::uint64_t planStep, int frames = 1) {
    return {.planStep = planStep,
            .led = 1,
            .levels = LedLevels::only(Band::G, 65535),
            .exposure = Microseconds(320),
            .frames = frames};
}

/// No report was damaged, unknown or another's. On a machine that is busy elsewhere an ACK may come
/// after the driver has read it by other means, and the system may drop a STATUS: no fault of ours.
inline void expectCleanReports(const driver::LinkCounters& counters) {
    EXPECT_EQ(counters.badReports, 0U);
    EXPECT_EQ(counters.unknownReports, 0U);
    EXPECT_EQ(counters.foreignAcks, 0U);
    EXPECT_EQ(counters.missedEvents, 0U);
}

}  // namespace gonio::device_test
