// What captures take, and which rigs are refused.

#include "proc/plan/rig_model.h"

#include <gtest/gtest.h>

#include <limits>

#include "proc/plan/information.h"

namespace {

using namespace gonio;
using namespace gonio::proc;

RigModel goodRig() {
    RigModel rig;
    rig.levels = {1, 0.05};
    rig.exposures = {Seconds(20e-6), Seconds(5e-3), Seconds(0.04), Seconds(1)};
    return rig;
}

TEST(ShotCost, ShortFramesTakeThePeriodAndLongOnesWhatTheyAre) {
    const ShotCost cost(RigTiming{.framePeriod = Seconds(0.04),
                                  .readout = Seconds(0.001),
                                  .handover = Seconds(0.003),
                                  .ledSettle = Seconds(0.005),
                                  .transfer = Seconds(0.039)});
    using namespace std::chrono_literals;
    EXPECT_EQ(cost.frame(Seconds(0.001)), 40ms);
    EXPECT_EQ(cost.lastFrame(Seconds(0.001)), 40ms);  // settling is hidden by the period
    EXPECT_EQ(cost.lastFrame(Seconds(0.032)), 40ms);  // just
    EXPECT_EQ(cost.lastFrame(Seconds(0.0321)), 40100us);
    EXPECT_EQ(cost.frame(Seconds(0.1)), 101ms);
    EXPECT_EQ(cost.lastFrame(Seconds(0.1)), 108ms);
    EXPECT_EQ(cost.capture(Seconds(0.1), 3), 310ms);
    EXPECT_EQ(cost.capture(Seconds(0.1), 0), 0ms);
    EXPECT_EQ(cost.darkCapture(Seconds(0.1), 2), 204ms);
}

TEST(RigModel, PilotsAreTheEndsOfTheRangeEachOnce) {
    RigModel rig = goodRig();
    const std::vector<ShotKind> pilots = rig.pilotShots();
    ASSERT_EQ(pilots.size(), 3U);
    EXPECT_EQ(pilots[0], (ShotKind{0.05, Seconds(20e-6)}));
    EXPECT_EQ(pilots[1], (ShotKind{1, Seconds(20e-6)}));
    EXPECT_EQ(pilots[2], (ShotKind{1, Seconds(0.04)}));  // no longer than a pilot may be
    rig.levels = {1};
    rig.exposures = {Seconds(0.5)};
    EXPECT_EQ(rig.pilotShots().size(), 1U);
}

TEST(RigModel, RefusesWhatIsOutOfItsDomain) {
    EXPECT_TRUE(goodRig().check());
    const auto refuses = [](auto change) {
        RigModel rig = goodRig();
        change(rig);
        const Result<void> checked = rig.check();
        return !checked && checked.error().kind == ErrorKind::Usage;
    };
    EXPECT_TRUE(refuses([](RigModel& r) { r.levels.clear(); }));
    EXPECT_TRUE(refuses([](RigModel& r) { r.levels = {0.05, 1}; }));
    EXPECT_TRUE(refuses([](RigModel& r) { r.levels = {1.5}; }));
    EXPECT_TRUE(refuses([](RigModel& r) { r.exposures.assign(13, Seconds(1)); }));
    EXPECT_TRUE(refuses([](RigModel& r) { r.exposures = {Seconds(2), Seconds(1)}; }));
    EXPECT_TRUE(refuses(
        [](RigModel& r) { r.exposures = {Seconds(std::numeric_limits<double>::quiet_NaN())}; }));
    EXPECT_TRUE(refuses([](RigModel& r) { r.timing.framePeriod = Seconds(0); }));
    EXPECT_TRUE(refuses([](RigModel& r) { r.timing.transfer = Seconds(1); }));
    EXPECT_TRUE(refuses([](RigModel& r) { r.sensor.noise.electronsPerDn = 0; }));
    EXPECT_TRUE(refuses([](RigModel& r) { r.sensor.headroom = 1.1; }));
    EXPECT_TRUE(refuses([](RigModel& r) { r.maxFrames = 0; }));
}

TEST(SensorModel, DarkCurrentDoublesWithTemperature) {
    SensorModel sensor;
    sensor.celsius = 25 + 3 * sensor.darkDoublingKelvin;
    EXPECT_NEAR(
        sensor.noiseNow().darkElectronsPerSecond, 8 * sensor.noise.darkElectronsPerSecond, 1e-9);
}

TEST(ShotOption, InformationHasItsLimits) {
    const SensorModel sensor;
    const ShotOption shot = shotOption(sensor, {.level = 0.5, .exposure = Seconds(0.01)}, 4);
    EXPECT_DOUBLE_EQ(shot.tau, 0.005);
    EXPECT_EQ(shot.information(1e4, 0), 0);
    EXPECT_EQ(shot.information(shot.reach * 1.0001, 5), 0);
    EXPECT_GT(shot.information(shot.reach, 5), 0);
    // As n -> infinity: tau^2 / v.
    EXPECT_NEAR(
        shot.information(1e4, 100'000'000) * shot.darkVariance / (shot.tau * shot.tau), 1, 1e-6);
    // framesFor is the least n.
    const double wanted = shot.information(1e4, 7);
    EXPECT_EQ(shot.framesFor(1e4, wanted * 0.9999), 7);
    EXPECT_EQ(shot.framesFor(1e4, wanted * 1.0001), 8);
    EXPECT_EQ(shot.framesFor(1e4, shot.tau * shot.tau / shot.darkVariance), 0);
}

TEST(ShotOption, DarkCurrentThatFillsThePixelLeavesNoReach) {
    SensorModel sensor;
    sensor.noise.darkElectronsPerSecond = 1e6;
    EXPECT_EQ(shotOption(sensor, {.level = 1, .exposure = Seconds(1)}, 1).reach, 0);
}

}  // namespace
