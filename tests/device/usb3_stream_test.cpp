// The real USB code on a rig whose camera speaks SuperSpeed: packets of 1024 bytes, 60 frames a
// second.

#include "tests/device/usb_rig_fixture.h"

namespace gonio::device_test {
namespace {

sim::DeviceConfig superSpeed() {
    sim::DeviceConfig config = rigConfig();
    config.camera = sim::CameraKind::Usb3;
    return config;
}

class Usb3RigTest : public UsbRigTest {
protected:
    Usb3RigTest() : UsbRigTest(superSpeed()) {}

    /// Opens the rig and its twin behind the in-process door with this window, and holds their
    /// frames against each other.
    void expectTwinFrames(const Window& window,
                          driver::PixelFormat format,
                          const driver::CaptureRequest& request) {
        mock.live().warmUp(window);
        const auto transport = opened();
        ASSERT_TRUE(transport);
        auto real = driver::Rig::open(*transport, kSession);
        ASSERT_TRUE(real) << real.error().message;
        sim::InProcessDoor door(superSpeed());
        door.device().place(mattGrey());
        auto twin = driver::Rig::open(door, kSession);
        ASSERT_TRUE(twin);
        ASSERT_TRUE(real->configure(window, format));
        ASSERT_TRUE(twin->configure(window, format));
        EXPECT_EQ(real->identify().framePeriod, Microseconds(16'667));
        const auto seen = real->capture(request);
        const auto wanted = twin->capture(request);
        ASSERT_TRUE(seen) << seen.error().message;
        ASSERT_TRUE(wanted);
        ASSERT_EQ(seen->size(), wanted->size());
        for (std::size_t i = 0; i < seen->size(); ++i)
            EXPECT_EQ((*seen)[i].pixels, (*wanted)[i].pixels) << "frame " << i;
        EXPECT_EQ(real->anomalies(), driver::Anomalies{});
        expectCleanReports(real->link().counters());
    }
};

TEST_F(Usb3RigTest, ASecondsFramesAreThoseOfTheInProcessDoor) {
    expectTwinFrames(kSmallWindow, driver::PixelFormat::Mono12Packed, litFrames(1, 60));
}

TEST_F(Usb3RigTest, ADataChunkThatFillsItsPacketIsEndedByAnEmptyOne) {
    // 40 x 12 pixels of two bytes and the header are one packet of 1024 bytes.
    constexpr Window kOnePacket{.x = 640, .y = 512, .size = {40, 12}, .binning = 1};
    static_assert(driver::kChunkHeaderBytes + 2 * 40 * 12 == 1024);
    expectTwinFrames(kOnePacket, driver::PixelFormat::Mono16, litFrames(1, 8));
}

}  // namespace
}  // namespace gonio::device_test
