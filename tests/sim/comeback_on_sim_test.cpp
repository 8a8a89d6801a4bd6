// A simulated rig whose cable is pulled in mid-capture, in virtual time: what comes back is
// bit-equal to what an undisturbed rig gives, with drift switched off.

#include <gtest/gtest.h>

#include "driver/rig.h"
#include "proc/models/spec.h"
#include "sim/in_process.h"
#include "tests/driver/loose_cable.h"

namespace gonio {
namespace {

using namespace std::chrono_literals;

constexpr Window kWindow{.x = 512, .y = 384, .size = {64, 64}, .binning = 1};
constexpr std::uint64_t kSession = 0x1122334455667788;
const driver::CaptureRequest kRequest{.planStep = 5,
                                      .led = 1,
                                      .levels = LedLevels::only(Band::G, 65535),
                                      .exposure = Microseconds(320),
                                      .frames = 4};
const driver::CaptureRequest kNext{.planStep = 6,
                                   .led = 2,
                                   .levels = LedLevels::only(Band::R, 65535),
                                   .exposure = Microseconds(640),
                                   .frames = 2};

void placeGrey(sim::Device& device) {
    device.place({.role = sim::Role::Sample,
                  .surface = std::move(*proc::makeModel("lambert,albedo=0.5")),
                  .wedge = {}});
}

/// Both captures, the second armed ahead.
struct Pictures {
    std::vector<Frame> first, second;
};

Pictures taken(driver::Rig& rig) {
    auto first = rig.capture(kRequest, {kNext});
    EXPECT_TRUE(first) << first.error().message;
    auto second = rig.capture(kNext);
    EXPECT_TRUE(second) << second.error().message;
    if (!first || !second) return {};
    return {std::move(first->frames), std::move(second->frames)};
}

void expectEqual(const std::vector<Frame>& seen, const std::vector<Frame>& wanted) {
    ASSERT_EQ(seen.size(), wanted.size());
    for (std::size_t i = 0; i < seen.size(); ++i) {
        EXPECT_EQ(seen[i].pixels, wanted[i].pixels) << "frame " << i;
        EXPECT_EQ(seen[i].led, wanted[i].led);
    }
}

/// As the rig had them, but for its uptime.
void expectCounters(const driver::Stats& seen, const driver::Stats& wanted) {
    EXPECT_EQ(seen.framesMade, wanted.framesMade);
    EXPECT_EQ(seen.commandsDone, wanted.commandsDone);
    EXPECT_EQ(seen.resends, wanted.resends);
    EXPECT_EQ(seen.lapses, wanted.lapses);
}

/// A gap is no anomaly of the stream, and no fault of the reports.
void expectNothingCounted(driver::Rig& rig) {
    EXPECT_EQ(rig.anomalies(), driver::Anomalies{}) << rig.anomalies().text();
    EXPECT_EQ(rig.link().counters(), driver::LinkCounters{});
}

TEST(ComebackOnSim, ACablePulledAtAnyCallCostsNoFrame) {
    sim::InProcessDoor twin({.errors = {}});
    placeGrey(twin.device());
    auto undisturbed = driver::Rig::open(twin, kSession);
    ASSERT_TRUE(undisturbed->configure(kWindow));
    const Pictures wanted = taken(*undisturbed);
    int resent = 0, redone = 0, cut = 0;
    for (;; ++cut) {
        SCOPED_TRACE("call " + std::to_string(cut));
        sim::InProcessDoor door({.errors = {}});
        placeGrey(door.device());
        driver::test::Replugged plugs(door, [&] { door.device().linkLost(); });
        driver::Stats then;
        plugs.onPlug = [&](driver::test::LooseCable&) {
            door.device().advanceTo(door.device().now() + 3s);  // the gap
            then = door.device().stats();
        };
        auto rig = driver::Rig::open(plugs.cable(), kSession);
        ASSERT_TRUE(rig) << rig.error().message;
        ASSERT_TRUE(rig->configure(kWindow));
        rig->onLost(plugs.comeback());
        plugs.cable().breaksAt = plugs.cable().calls + cut;
        const Pictures seen = taken(*rig);
        expectEqual(seen.first, wanted.first);
        expectEqual(seen.second, wanted.second);
        EXPECT_EQ(plugs.touches(), 0);
        for (const auto& gap : rig->takeInterruptions()) {
            EXPECT_TRUE(gap.sameBoot);
            EXPECT_GE(gap.lasted, 3s);
            resent += gap.resent;
            redone += gap.redone;
            expectCounters(gap.stats.value(), then);
        }
        expectNothingCounted(*rig);
        if (plugs.losses.empty() || HasFailure()) break;
    }
    EXPECT_GT(cut, 40);
    EXPECT_GT(resent, 0);
    EXPECT_GT(redone, 0);
}

TEST(ComebackOnSim, CountersBeginAnewWithAnotherBootAndNothingIsHeldAgainstIt) {
    sim::InProcessDoor door({.errors = {}});
    placeGrey(door.device());
    driver::test::Replugged plugs(door, [&] { door.device().powerCycle(); });
    plugs.onPlug = [&](driver::test::LooseCable&) {
        door.device().advanceTo(door.device().now() + 3s);
    };
    auto rig = driver::Rig::open(plugs.cable(), kSession);
    ASSERT_TRUE(rig->configure(kWindow));
    rig->onLost(plugs.comeback());
    (void)taken(*rig);
    const auto before = rig->link().stats();
    ASSERT_TRUE(before);
    EXPECT_EQ(before->framesMade, 6U);
    plugs.cable().breaksAt = plugs.cable().calls;
    EXPECT_FALSE(rig->capture(kRequest)) << "another boot is told";
    (void)taken(*rig);
    const auto gaps = rig->takeInterruptions();
    ASSERT_EQ(gaps.size(), 1U);
    EXPECT_FALSE(gaps[0].sameBoot);
    EXPECT_EQ(gaps[0].stats.value().framesMade, 0U);
    EXPECT_EQ(gaps[0].stats.value().commandsDone, 0U);
    EXPECT_EQ(rig->link().stats()->framesMade, 6U) << "of this boot";
    expectNothingCounted(*rig);
}

TEST(ComebackOnSim, AfterTheThirdStallTheRigIsDarkAndFreeForAnyOther) {
    sim::InProcessDoor door({.errors = {}});
    placeGrey(door.device());
    auto rig = driver::Rig::open(door, kSession);
    ASSERT_TRUE(rig->configure(kWindow));
    bool lit = false;
    const auto capture = rig->capture(kRequest, {}, [&](const Frame&) -> Result<void> {
        lit = lit || door.device().lit();
        door.usb().cause(sim::FaultKind::StallBulk);
        return {};
    });
    ASSERT_FALSE(capture);
    EXPECT_NE(capture.error().message.find("three times in 10 s"), std::string::npos)
        << capture.error().message;
    EXPECT_TRUE(lit);
    EXPECT_FALSE(door.device().lit());
    const auto free = door.openAgain();
    ASSERT_TRUE(free);
    const Nanoseconds then = door.device().now();
    auto other = driver::Rig::open(**free, kSession + 1);
    ASSERT_TRUE(other) << other.error().message;
    EXPECT_LT(door.device().now() - then, 100ms);
    ASSERT_TRUE(other->configure(kWindow));
    EXPECT_TRUE(other->capture(kRequest));
}

}  // namespace
}  // namespace gonio
