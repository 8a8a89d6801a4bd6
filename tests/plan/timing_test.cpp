// The time model against the simulated rig: the captures of a plan, armed ahead as a measurement
// arms them, on the rig's own clock.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "driver/rig.h"
#include "proc/plan/rig_model.h"
#include "sim/in_process.h"

namespace {

using namespace gonio;
using namespace gonio::proc;

constexpr Window kWindow{.x = 128, .y = 0, .size = {1024, 1024}, .binning = 1};

struct Shot {
    std::optional<int> led;
    double level = 1;
    Microseconds exposure{0};
    int frames = 1;
};

driver::CaptureRequest request(const Shot& shot, std::uint64_t step) {
    driver::CaptureRequest made{
        .planStep = step, .led = shot.led, .exposure = shot.exposure, .frames = shot.frames};
    if (shot.led)
        made.levels = LedLevels::only(Band::G, static_cast<std::uint16_t>(shot.level * 65535));
    return made;
}

Seconds onTheRig(const std::vector<Shot>& shots, sim::CameraKind camera) {
    sim::InProcessDoor door({.errors = {}, .camera = camera});
    auto rig = driver::Rig::open(door, 0x1122334455667788).value();
    EXPECT_TRUE(rig.configure(kWindow));
    const Nanoseconds begin = door.device().now();
    for (std::size_t i = 0; i < shots.size(); ++i) {
        driver::ArmAhead ahead;
        if (i + 1 < shots.size()) ahead.next = request(shots[i + 1], i + 2);
        EXPECT_TRUE(rig.capture(request(shots[i], i + 1), ahead));
    }
    return door.device().now() - begin;
}

Seconds byTheModel(const std::vector<Shot>& shots, const RigTiming& timing) {
    const ShotCost cost(timing);
    Nanoseconds sum{0};
    for (const Shot& shot : shots) {
        const Seconds granted =
            sim::grantedExposure(static_cast<std::uint32_t>(shot.exposure.count()));
        sum +=
            shot.led ? cost.capture(granted, shot.frames) : cost.darkCapture(granted, shot.frames);
    }
    return sum + timing.handover + timing.ledSettle + timing.transfer;
}

/// Pilots, dark frames, and a state of a strict plan: short and long exposures, levels that change.
const std::vector<Shot> kRun{{0, 0.0025, Microseconds(20), 1},
                             {0, 1, Microseconds(20), 1},
                             {0, 1, Microseconds(40000), 1},
                             {1, 0.0025, Microseconds(20), 1},
                             {1, 1, Microseconds(40000), 1},
                             {std::nullopt, 0, Microseconds(20), 2},
                             {std::nullopt, 0, Microseconds(40000), 2},
                             {0, 0.05, Microseconds(80), 1},
                             {0, 1, Microseconds(5120), 1},
                             {0, 1, Microseconds(40000), 3},
                             {1, 0.05, Microseconds(20), 2}};

TEST(RigTiming, BoundsTheSimulatedUsb2RigFromAboveWithinSixPerCent) {
    const double model = byTheModel(kRun, RigTiming::usb2()).count();
    const double rig = onTheRig(kRun, sim::CameraKind::Usb2).count();
    EXPECT_LE(rig, model) << rig / model;
    EXPECT_GT(rig, 0.94 * model);
}

TEST(RigTiming, BoundsTheSimulatedUsb3RigFromAboveWithinSixPerCent) {
    const double model = byTheModel(kRun, RigTiming::usb3()).count();
    const double rig = onTheRig(kRun, sim::CameraKind::Usb3).count();
    EXPECT_LE(rig, model) << rig / model;
    EXPECT_GT(rig, 0.94 * model);
}

}  // namespace
