// What the real USB code allocates and copies while frames stream.

#include <thread>

#include "tests/device/usb_rig_fixture.h"
#include "tests/driver/watched_chain.h"

namespace gonio::device_test {
namespace {

using namespace std::chrono_literals;
using driver::test::ArmWatch;
using driver::test::chainOf;
using driver::test::takeChain;

constexpr const char* kTooBusy = "this machine is too busy: reports were late in each of 5 runs";

class UsbStreaming : public UsbRigTest {
protected:
    UsbStreaming() {
        EXPECT_TRUE(rig) << rig.error().message;
        if (const auto set = rig->configure(kSmallWindow); !set)
            ADD_FAILURE() << set.error().message;
    }
    /// Before it is claimed: warming up takes longer than a heart may stand still.
    [[nodiscard]] std::unique_ptr<driver::Transport> warmedUp() {
        mock.live().warmUp(kSmallWindow);
        return opened();
    }
    /// A chain in which all reports came in time. On a machine that is busy elsewhere they fall
    /// silent for 300 ms, and are opened anew: that allocates, and is not the frames' way.
    std::optional<driver::test::ChainTaken> taken(std::uint64_t planStep,
                                                  std::initializer_list<int> frames) {
        for (int tries = 0; tries < 5; ++tries, planStep += 100) {
            const std::uint32_t before = rig->link().reopens();
            auto seen = takeChain(*rig, watch, chainOf(litFrames(planStep), frames));
            if (rig->link().reopens() == before) return seen;
        }
        return std::nullopt;
    }
    std::unique_ptr<driver::Transport> transport = warmedUp();
    ArmWatch watch{*transport, ArmWatch::Behind::Driver};
    Result<driver::Rig> rig = driver::Rig::open(watch, kSession);
};

TEST_F(UsbStreaming, AllocatesNothingAfterArmOnAnyThread) {
    for (const std::uint64_t planStep : {1U, 2U}) {
        const auto seen = taken(planStep, {30});
        if (!seen) GTEST_SKIP() << kTooBusy;
        EXPECT_EQ(seen->spent.allocations, 0U);
        EXPECT_EQ(seen->frames, 30);
    }
}

TEST_F(UsbStreaming, AllocatesNothingAlongAChainThatIsArmedAhead) {
    const auto seen = taken(1, {8, 3, 8, 1, 5, 8});
    if (!seen) GTEST_SKIP() << kTooBusy;
    EXPECT_EQ(seen->spent.allocations, 0U);
    EXPECT_EQ(seen->frames, 33);
    EXPECT_EQ(seen->ahead, (std::vector<bool>{false, true, true, true, true, true}));
}

TEST_F(UsbStreaming, CopiesEachByteOnceFromTheTransferToTheFrame) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "address sanitizer has copies of its own";
#endif
    const auto seen = takeChain(*rig, watch, chainOf(litFrames(1), {8, 8}));
    const auto sent = static_cast<std::size_t>(seen.frames) *
                      *driver::frameBytes(kSmallWindow, driver::PixelFormat::Mono12Packed);
    EXPECT_GE(seen.spent.bytesCopied, sent);
    EXPECT_LT(seen.spent.bytesCopied, sent + sent / 5) << "but for headers and reports";
}

TEST_F(UsbStreaming, ASlowReaderHoldsTheRigBackAndLosesNothing) {
    constexpr int kFrames = 30;
    const auto made = [&] {
        std::uint32_t frames = 0;
        mock.live().with([&](sim::FaultyUsb& usb) { frames = usb.device().stats().framesMade; });
        return static_cast<int>(frames);
    };
    const int before = made();
    int given = 0, madeMeanwhile = 0;
    const auto capture = rig->capture(litFrames(1, kFrames), {}, [&](const Frame&) -> Result<void> {
        if (++given > 1) return {};
        for (int i = 0; i < 12; ++i) {  // the rig has time for all
            std::this_thread::sleep_for(100ms);
            if (auto alive = rig->keepAlive(); !alive) return alive;
        }
        madeMeanwhile = made() - before;
        return {};
    });
    ASSERT_TRUE(capture) << capture.error().message;
    EXPECT_EQ(given, kFrames);
    EXPECT_LT(madeMeanwhile, kFrames) << "the ring holds 2 or 3 of them, the rig 8";
    EXPECT_EQ(made() - before, kFrames) << "none was exposed twice";
    EXPECT_EQ(capture->anomalies, driver::Anomalies{});
    EXPECT_EQ(capture->resends, 0);
}

}  // namespace
}  // namespace gonio::device_test
