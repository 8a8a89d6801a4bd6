// What the real USB code allocates while frames stream.

#include "tests/device/usb_rig_fixture.h"
#include "tests/driver/allocation_watch.h"

namespace gonio::device_test {
namespace {

class UsbStreaming : public UsbRigTest {};

TEST_F(UsbStreaming, AllocatesNothingAfterArmOnEitherThread) {
    mock.live().warmUp(kSmallWindow);
    const auto transport = opened();
    ASSERT_TRUE(transport);
    driver::test::AllocationWatch watched(*transport, true);
    auto rig = driver::Rig::open(watched, kSession);
    ASSERT_TRUE(rig) << rig.error().message;
    ASSERT_TRUE(rig->configure(kSmallWindow));
    for (const std::uint64_t planStep : {1U, 2U}) {
        int left = 30;
        std::size_t seen = 0;
        const auto capture =
            rig->capture(litFrames(planStep, left), {}, [&](const Frame&) -> Result<void> {
                if (--left > 0) return {};
                seen = driver::test::allocationsSeen();
                driver::test::stopWatching();
                return {};
            });
        ASSERT_TRUE(capture) << capture.error().message;
        EXPECT_EQ(left, 0);
        EXPECT_EQ(seen, 0U);
    }
}

}  // namespace
}  // namespace gonio::device_test
