// Frames in a stream, in virtual time: what they allocate, and who waits for whom.

#include <gtest/gtest.h>

#include <vector>

#include "driver/rig.h"
#include "sim/in_process.h"
#include "tests/driver/watched_chain.h"

namespace gonio {
namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t kSession = 0x1122334455667788;
constexpr Window kWindow{.x = 512, .y = 384, .size = {256, 256}, .binning = 1};

driver::CaptureRequest dark(std::uint64_t planStep, int frames) {
    return {.planStep = planStep,
            .led = std::nullopt,
            .levels = {},
            .exposure = Microseconds(320),
            .frames = frames};
}

using driver::test::chainOf;
using driver::test::takeChain;

struct Opened {
    sim::InProcessDoor door{{.errors = {}}};
    driver::test::ArmWatch watch{door, driver::test::ArmWatch::Behind::Simulator};
    Result<driver::Rig> rig = driver::Rig::open(watch, kSession);

    Opened() {
        EXPECT_TRUE(rig) << rig.error().message;
        EXPECT_TRUE(rig->configure(kWindow));
    }
};

/// Allocations between the ARM of a capture and its last frame.
template <class Take>
std::size_t allocated(driver::Rig& rig, const driver::CaptureRequest& request, Take take) {
    int left = request.frames;
    (void)driver::test::takeSpent();
    const auto capture = rig.capture(request, {}, [&](Frame&& frame) -> Result<void> {
        if (--left == 0) driver::test::captureTaken();
        take(std::move(frame));
        return {};
    });
    EXPECT_TRUE(capture) << capture.error().message;
    EXPECT_EQ(left, 0);
    return driver::test::takeSpent().allocations;
}

TEST(Streaming, AllocatesNothingAfterArm) {
    Opened on;
    EXPECT_EQ(allocated(*on.rig, dark(1, 100), [](const Frame&) {}), 0U);
    EXPECT_EQ(allocated(*on.rig, dark(2, 100), [](const Frame&) {}), 0U);
}

TEST(Streaming, AllocatesNothingAfterArmAlongAChainThatIsArmedAhead) {
    Opened on;
    const auto seen = takeChain(*on.rig, on.watch, chainOf(dark(1, 0), {8, 3, 8, 1, 5, 8, 8, 2}));
    EXPECT_EQ(seen.spent.allocations, 0U);
    EXPECT_EQ(seen.frames, 43);
    EXPECT_EQ(seen.ahead, (std::vector<bool>{false, true, true, true, true, true, true, true}));
}

TEST(Streaming, WhatNeedsMoreMemoryInAChainIsArmedInItsTurn) {
    Opened on;
    const auto seen = takeChain(*on.rig, on.watch, chainOf(dark(1, 0), {2, 3, 20, 60, 60, 1}));
    EXPECT_EQ(seen.spent.allocations, 0U) << "it is made before an ARM, never after";
    EXPECT_EQ(seen.ahead, (std::vector<bool>{false, true, false, true, true, true}))
        << "20 frames and 60 were prepared for together";
}

TEST(Streaming, CopiesEachByteOnceOnItsWayToTheFrame) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "address sanitizer has copies of its own";
#endif
    Opened on;
    const auto seen = takeChain(*on.rig, on.watch, chainOf(dark(1, 0), {8, 8, 8}));
    const auto sent = static_cast<std::size_t>(seen.frames) *
                      *driver::frameBytes(kWindow, driver::PixelFormat::Mono12Packed);
    EXPECT_GE(seen.spent.bytesCopied, sent);
    EXPECT_LT(seen.spent.bytesCopied, sent + sent / 20) << "but for headers and reports";
}

TEST(Streaming, AFewFramesThatTheSinkKeepsWereAllocatedBeforeArm) {
    Opened on;
    std::vector<Frame> kept;
    kept.reserve(8);
    const auto keep = [&](Frame frame) { kept.push_back(std::move(frame)); };
    EXPECT_EQ(allocated(*on.rig, dark(1, 8), keep), 0U);
    EXPECT_EQ(kept.size(), 8U);
}

TEST(Streaming, AnAllocationWouldBeSeen) {
    Opened on;
    std::vector<std::vector<int>> kept;
    const auto grow = [&](const Frame&) { kept.emplace_back(100); };
    EXPECT_GE(allocated(*on.rig, dark(1, 3), grow), 2U) << "all but the last are in the time";
}

TEST(Streaming, TheMemoryOfFramesIsUsedAgain) {
    Opened on;
    std::vector<const std::uint16_t*> places;
    const auto note = [&](const Frame& frame) { places.push_back(frame.pixels.pixels().data()); };
    (void)allocated(*on.rig, dark(1, 60), note);
    std::sort(places.begin(), places.end());
    const auto different = std::unique(places.begin(), places.end()) - places.begin();
    EXPECT_LE(different, 2 * on.rig->link().ident().frameRam + 2);
}

TEST(Streaming, ASlowReaderHoldsTheRigBackAndLosesNothing) {
    Opened slow, quick;
    std::vector<Frame> frames;
    const auto capture = slow.rig->capture(dark(1, 40), {}, [&](Frame frame) -> Result<void> {
        frames.push_back(std::move(frame));
        slow.door.device().advanceTo(slow.door.device().now() + 300ms);  // seven frame periods
        return slow.rig->keepAlive();
    });
    ASSERT_TRUE(capture) << capture.error().message;
    const auto twin = quick.rig->capture(dark(1, 40));
    ASSERT_TRUE(twin);
    ASSERT_EQ(frames.size(), 40U);
    for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(frames[i].pixels, (*twin)[i].pixels);
    EXPECT_EQ(capture->anomalies, driver::Anomalies{});
    EXPECT_EQ(capture->resends + capture->recaptures, 0);
    EXPECT_EQ(slow.door.device().stats().fifoOverruns, 0U);
    EXPECT_EQ(slow.door.device().stats().framesMade, 40U) << "none was exposed twice";
}

TEST(Streaming, AReaderThatIsBusyForSecondsLosesNothing) {
    Opened on;
    int given = 0;
    const auto capture = on.rig->capture(dark(1, 20), {}, [&](const Frame&) -> Result<void> {
        ++given;
        for (int i = 0; i < 20; ++i) {  // two seconds, in which the heart beats
            on.door.device().advanceTo(on.door.device().now() + 100ms);
            if (auto alive = on.rig->keepAlive(); !alive) return alive;
        }
        return {};
    });
    ASSERT_TRUE(capture) << capture.error().message;
    EXPECT_EQ(given, 20);
    EXPECT_EQ(capture->anomalies, driver::Anomalies{});
    EXPECT_EQ(capture->resends + capture->recaptures, 0);
    EXPECT_EQ(on.door.device().stats().framesMade, 20U) << "none was exposed twice";
}

// Frames that were asked for again wait in the rig until there is memory for a transfer, and it
// takes no more requests than its RAM can serve: no reason to give the capture up.
TEST(Streaming, RigThatCanQueueNoMoreResendsIsReadBeforeItIsAskedAgain) {
    Opened on;
    const auto undisturbed = on.rig->capture(dark(1, 16));
    ASSERT_TRUE(undisturbed) << undisturbed.error().message;
    for (const std::string lasting : {"1s", "2s", "3s", "4s"}) {
        SCOPED_TRACE(lasting);
        auto script = sim::FaultScript::parse("on chunk 9 memory for 0 transfers for " + lasting);
        ASSERT_TRUE(script) << script.error().message;
        on.door.usb().play(std::move(*script));
        const auto seen = on.rig->capture(dark(1, 16));
        ASSERT_TRUE(seen) << seen.error().message;
        ASSERT_EQ(seen->size(), 16U);
        for (std::size_t i = 0; i < 16; ++i)
            EXPECT_EQ((*seen)[i].pixels, (*undisturbed)[i].pixels) << i;
    }
}

}  // namespace
}  // namespace gonio
