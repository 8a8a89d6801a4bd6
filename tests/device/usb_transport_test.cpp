// The real USB code on a simulated rig: who is there, and what it measures.

#include "driver/usb_transport.h"

#include "tests/device/usb_rig_fixture.h"

namespace gonio::device_test {
namespace {

using namespace std::chrono_literals;

TEST_F(UsbRigTest, IsListedWithAllThatIdentifiesIt) {
    const auto rigs = driver::listUsb();
    ASSERT_TRUE(rigs) << rigs.error().message;
    ASSERT_EQ(rigs->size(), 1U);
    const driver::UsbRig& rig = rigs->front();
    EXPECT_EQ(rig.serial, "SIM-0042");
    EXPECT_EQ(rig.vendor, 0x1209);
    EXPECT_EQ(rig.product, 0x0001);
    EXPECT_EQ(rig.place, "1-1");
    EXPECT_EQ(rig.protocol, "GRP/1.0");
    EXPECT_EQ(rig.obstacle, "");
}

TEST_F(UsbRigTest, SaysWhoItIs) {
    const auto transport = opened();
    ASSERT_TRUE(transport);
    EXPECT_EQ(transport->strings().serial, "SIM-0042");
    EXPECT_EQ(transport->strings().protocol, "GRP/1.0");
    const auto rig = driver::Rig::open(*transport, kSession);
    ASSERT_TRUE(rig) << rig.error().message;
    EXPECT_EQ(rig->identify().ledAngles.size(), 4U);
}

TEST_F(UsbRigTest, FramesAreThoseOfTheInProcessDoor) {
    mock.live().warmUp(kSmallWindow);
    const auto transport = opened();
    ASSERT_TRUE(transport);
    auto real = driver::Rig::open(*transport, kSession);
    ASSERT_TRUE(real) << real.error().message;
    sim::InProcessDoor door(rigConfig());
    door.device().place(mattGrey());
    auto twin = driver::Rig::open(door, kSession);
    ASSERT_TRUE(twin);
    ASSERT_TRUE(real->configure(kSmallWindow));
    ASSERT_TRUE(twin->configure(kSmallWindow));
    for (std::uint64_t step = 1; step <= 3; ++step) {
        const auto seen = real->capture(litFrames(step, 4));
        const auto wanted = twin->capture(litFrames(step, 4));
        ASSERT_TRUE(seen) << seen.error().message;
        ASSERT_TRUE(wanted);
        ASSERT_EQ(seen->size(), 4U);
        for (std::size_t i = 0; i < seen->size(); ++i)
            EXPECT_EQ((*seen)[i].pixels, (*wanted)[i].pixels);
    }
    EXPECT_EQ(real->anomalies(), driver::Anomalies{});
}

}  // namespace
}  // namespace gonio::device_test
