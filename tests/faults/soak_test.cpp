// Ten frames a second with a fault of any kind every ten seconds: nothing is lost, nothing is
// wrong, and the driver counts what was done to it, kind by kind. An hour of virtual time nightly.

#include <gtest/gtest.h>

#include <cstdlib>

#include "driver/rig.h"
#include "sim/in_process.h"
#include "tests/faults/rig_door.h"

namespace gonio::fault_test {
namespace {

using namespace std::chrono_literals;
using driver::CaptureRequest;
using driver::Rig;
using sim::FaultKind;

constexpr int kFramesPerCapture = 5;
constexpr Nanoseconds kCapturePeriod = 500ms;  // ten frames a second
constexpr std::uint64_t kSession = 0x1122334455667788;

constexpr const char* kFaults =
    "every 10s lose chunk or duplicate chunk or swap chunks or flip 1..3 bits in payload or "
    "burst of 2..32 bits in payload or flip 1..3 bits in header or shorten chunk or "
    "lengthen chunk or empty packet or overflow or stall bulk or break transfer or lose ack or "
    "lose command or delay ack 120ms..180ms or unknown report or unknown chunk or unknown event "
    "or spoil report or drop 1..2 reports or unplug for 200ms..900ms or "
    "unplug quietly for 200ms..900ms or jump clock -10s..10s or silence reports or drifting led\n";

CaptureRequest requestOf(std::uint64_t step) {
    return {.planStep = step,
            .led = static_cast<int>(step % 3),
            .levels = LedLevels::only(kBands[step % 3], 65535),
            .exposure = Microseconds(500),
            .frames = kFramesPerCapture};
}

/// A rig, and the way back to it.
class Soak {
public:
    Soak() : first_(smallSetup().config) {
        placeSample(first_.device());
        (void)reopen();
    }
    Result<Rig> open() {
        auto rig = Rig::open(*door_, kSession);
        if (rig) rig->onLost([this](const Error&) { return comeBack(); });
        return rig;
    }
    sim::FaultyUsb& usb() { return first_.usb(); }

private:
    Result<driver::Transport*> comeBack() {
        for (int looks = 0; looks < 100; ++looks) {
            usb().advanceTo(usb().now() + 100ms);
            if (auto opened = reopen()) return opened;
        }
        return Error{ErrorKind::Interrupted, "it did not come back"};
    }
    Result<driver::Transport*> reopen() {
        auto door = first_.openAgain();
        if (!door) return door.error();
        door_ = std::move(*door);
        return door_.get();
    }
    sim::InProcessDoor first_;
    std::unique_ptr<sim::InProcessDoor> door_;
};

/// What `cause` did, kind by kind.
int did(const sim::FaultTally& tally, std::initializer_list<FaultKind> kinds) {
    int sum = 0;
    for (const FaultKind kind : kinds) sum += tally.of(kind);
    return sum;
}

TEST(Soak, LosesNoFrameTakesNoWrongOneAndCountsExactly) {
    const bool nightly = std::getenv("GONIO_NIGHTLY") != nullptr;
    const int captures = nightly ? 7200 : 600;  // an hour, five minutes
    Soak calm, storm;
    auto script = sim::FaultScript::parse(kFaults);
    ASSERT_TRUE(script) << script.error().message;
    auto twin = calm.open();
    auto rig = storm.open();
    ASSERT_TRUE(twin);
    ASSERT_TRUE(rig);
    ASSERT_TRUE(twin->configure(smallSetup().window));
    ASSERT_TRUE(rig->configure(smallSetup().window));
    storm.usb().play(*script);
    const Nanoseconds begin = storm.usb().now();
    int frames = 0, interruptions = 0;
    for (int i = 0; i < captures; ++i) {
        const auto step = static_cast<std::uint64_t>(i) + 1;
        const auto wanted = twin->capture(requestOf(step));
        const auto seen = rig->capture(requestOf(step));
        ASSERT_TRUE(wanted) << wanted.error().message;
        ASSERT_TRUE(seen) << seen.error().message;
        ASSERT_EQ(seen->size(), wanted->size());
        for (std::size_t k = 0; k < seen->size(); ++k)
            ASSERT_EQ((*seen)[k].pixels, (*wanted)[k].pixels) << "step " << step;
        frames += static_cast<int>(seen->size());
        interruptions += static_cast<int>(rig->takeInterruptions().size());
        // At ten frames a second, the heartbeat fed meanwhile.
        while (storm.usb().now() < begin + (i + 1) * kCapturePeriod) {
            storm.usb().advanceTo(storm.usb().now() + 50ms);
            ASSERT_TRUE(rig->keepAlive());
        }
    }
    interruptions += static_cast<int>(rig->takeInterruptions().size());
    EXPECT_EQ(frames, captures * kFramesPerCapture);
    const driver::Anomalies& seen = rig->anomalies();
    const driver::LinkCounters& link = rig->link().counters();
    const sim::FaultTally& done = storm.usb().tally();
    const auto counted = [](std::uint32_t n) { return static_cast<int>(n); };
    EXPECT_EQ(counted(seen.badPayloads),
              did(done, {FaultKind::FlipPayload, FaultKind::BurstPayload}));
    EXPECT_EQ(counted(seen.badHeaders), did(done, {FaultKind::FlipHeader}));
    EXPECT_EQ(counted(seen.badLengths),
              did(done, {FaultKind::ShortenChunk, FaultKind::LengthenChunk}));
    EXPECT_EQ(counted(seen.emptyTransfers), did(done, {FaultKind::EmptyPacket}));
    // The last chunk of a capture, come again, is stale: the capture is over.
    EXPECT_EQ(counted(seen.duplicates + seen.stale), did(done, {FaultKind::DuplicateChunk}));
    EXPECT_EQ(counted(seen.disordered),
              did(done, {FaultKind::DuplicateChunk, FaultKind::SwapChunks}));
    EXPECT_EQ(counted(seen.lostChunks),
              did(done,
                  {FaultKind::LoseChunk,
                   FaultKind::FlipHeader,
                   FaultKind::SwapChunks,
                   FaultKind::Overflow,
                   FaultKind::StallBulk,
                   FaultKind::BreakTransfer}));
    EXPECT_EQ(counted(seen.unknownTypes), did(done, {FaultKind::UnknownChunk}));
    EXPECT_EQ(counted(link.unknownReports), did(done, {FaultKind::UnknownReport}));
    EXPECT_EQ(counted(link.badReports), did(done, {FaultKind::SpoilReport}));
    EXPECT_EQ(counted(link.missedEvents), 0);
    EXPECT_EQ(counted(rig->link().reopens()), did(done, {FaultKind::SilenceReports}));
    EXPECT_EQ(interruptions, did(done, {FaultKind::Unplug, FaultKind::UnplugQuietly}));
    int faults = 0;
    for (std::size_t i = 0; i < sim::kFaultKinds; ++i) {
        const auto kind = static_cast<FaultKind>(i);
        if (kind != FaultKind::Plug) faults += done.of(kind);
    }
    RecordProperty("frames", frames);
    RecordProperty("faults", faults);
    printf("%d frames, %d faults, %.0f s of the rig's time\n",
           frames,
           faults,
           1e-9 * static_cast<double>((storm.usb().now() - begin).count()));
    EXPECT_GE(faults, captures / 20 - 2);
}

}  // namespace
}  // namespace gonio::fault_test
