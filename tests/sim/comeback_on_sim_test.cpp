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
        plugs.onPlug = [&](driver::test::LooseCable&) {
            door.device().advanceTo(door.device().now() + 3s);  // the gap
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
        }
        if (plugs.losses.empty() || HasFailure()) break;
    }
    EXPECT_GT(cut, 40);
    EXPECT_GT(resent, 0);
    EXPECT_GT(redone, 0);
}

}  // namespace
}  // namespace gonio
