// What is found out about the simulated rig, against what it is.

#include <gtest/gtest.h>

#include <cmath>

#include "daemon/corrections.h"
#include "daemon/gathering.h"
#include "daemon/references.h"
#include "daemon/rig_sweeps.h"
#include "daemon/stored_darks.h"
#include "driver/steady_clock.h"
#include "sim/in_process.h"
#include "sim/rig_errors.h"

namespace gonio::daemon {
namespace {

class RigSweeps : public testing::Test {
protected:
    void open(const std::string& errors, std::uint64_t seed = 5) {
        rig.reset();
        profile = *readProfile(defaultProfile());
        door = std::make_unique<sim::InProcessDoor>(
            sim::DeviceConfig{.seed = seed, .rig = *sim::parseRigErrors(errors, {})});
        door->device().place(
            {.role = sim::Role::White, .surface = loadReferences(profile)->white, .wedge = {}});
        auto opened = driver::Rig::open(*door, 7);
        ASSERT_TRUE(opened) << opened.error().message;
        rig.emplace(std::move(*opened));
    }
    [[nodiscard]] Bench bench() {
        return {.rig = *rig,
                .profile = profile,
                .nextPlanStep = nextPlanStep,
                .clock = computer,
                .step = [](const std::string&) { return Result<void>(); }};
    }
    RigProfile profile;
    driver::SteadyClock computer;
    std::unique_ptr<sim::InProcessDoor> door;
    std::optional<driver::Rig> rig;
    std::uint64_t nextPlanStep = 1;
};

TEST_F(RigSweeps, ALinearSensorIsFoundToBeWhatItIs) {
    open("none");
    const auto sensor = measureSensor(bench());
    ASSERT_TRUE(sensor) << sensor.error().message;
    const proc::PhotonTransfer& transfer = sensor->transfer;
    EXPECT_NEAR(transfer.electronsPerDn, 2.6, 4 * transfer.uElectronsPerDn);
    EXPECT_LT(transfer.uElectronsPerDn, 0.01);
    EXPECT_NEAR(transfer.readNoiseElectrons, 2.4, 0.1);
    EXPECT_LT(sensor->linearity.inlPercent, 0.03);
    EXPECT_EQ(sensor->celsius, 25);
    EXPECT_EQ(sensor->sweep.size(), 16U);
}

TEST_F(RigSweeps, ABentResponseIsFoundAndStraightened) {
    open("inl=0.006,drift,offset_us");
    const auto sensor = measureSensor(bench());
    ASSERT_TRUE(sensor) << sensor.error().message;
    // 4 x 0.006 m (1 - m) about its best line through zero: a quarter of the bow and more is left.
    EXPECT_GT(sensor->linearity.inlPercent, 0.2);
    EXPECT_LT(sensor->linearity.largestResidualDn / sensor->linearity.linearity.rangeDn, 2e-4);
    // Half the light is half of what is corrected, to 0.05 %: 1 % before.
    constexpr double kBlack = 60, kRange = 4095 - kBlack;
    const auto seen = [&](double m) { return kBlack + kRange * (m + 4 * 0.006 * m * (1 - m)); };
    const auto straight = [&](double m) {
        return sensor->linearity.linearity.corrected(seen(m)) - kBlack;
    };
    EXPECT_NEAR(straight(0.4) / straight(0.8), 0.5, 5e-4);
    EXPECT_GT(std::abs((seen(0.4) - kBlack) / (seen(0.8) - kBlack) - 0.5), 4e-3);
}

TEST_F(RigSweeps, NoWhiteNoSensor) {
    open("none");
    door->device().place({.role = sim::Role::Nothing, .surface = nullptr, .wedge = {}});
    const auto sensor = measureSensor(bench());
    ASSERT_FALSE(sensor);
    EXPECT_EQ(sensor.error().kind, ErrorKind::Quality);
    EXPECT_NE(sensor.error().message.find("white"), std::string::npos);
}

/// 0.01 of drift: red loses 2 x 0.01 at full heat, at which the board is 3 K warmer.
TEST_F(RigSweeps, TheLedsWarmUpIsFoundAndTakenOff) {
    open("drift=0.01");
    const auto leds = measureWarmUp(bench());
    ASSERT_TRUE(leds) << leds.error().message;
    const auto expectIs = [&](Band band, double truth) {
        const proc::WarmUpFit& fit = leds->bands[index(band)];
        // Relative to the light at T_0, not cold; the wander is no straight line, to 2 % of this.
        const double there = truth / (1 + truth * (fit.celsius - 26));
        EXPECT_NEAR(fit.perKelvin, there, 4 * fit.uPerKelvin + 0.02 * 0.02 / 3) << letter(band);
        EXPECT_LT(fit.uPerKelvin, 5e-4);
    };
    expectIs(Band::R, -0.02 / 3);
    expectIs(Band::G, -0.005 / 3);
    expectIs(Band::B, -0.005 / 3);
    EXPECT_NEAR(leds->fullMilliamp[0], 350, 0.1);

    // The same white, cold and after a minute of light: red is 2 % darker, and is not, corrected.
    const State red{2, Band::R};
    const auto light = [&](const std::vector<Frame>& frames) {
        std::vector<proc::RawExposure> bracket;
        for (const Frame& frame : frames) note(frame, red.band, bracket);
        double dn = 0;
        for (const std::uint16_t pixel : frames.front().pixels.pixels()) dn += pixel - 60.0;
        return std::pair(dn, dn / *lightOf(*leds, red.band, bracket));
    };
    Sequencer sequencer(*rig, profile, nextPlanStep);
    ASSERT_TRUE(sequencer.darks(4, [] { return Result<void>(); }));
    ASSERT_TRUE(rig->capture({.exposure = Microseconds(100'000), .frames = 100}));
    const auto cold = sequencer.expose(red, 1, Microseconds(160), 8);
    ASSERT_TRUE(sequencer.expose(red, 1, Microseconds(100'000), 60));
    const auto warm = sequencer.expose(red, 1, Microseconds(160), 8);
    ASSERT_TRUE(cold && warm);
    const double seen = light(*warm).first / light(*cold).first;
    const double corrected = light(*warm).second / light(*cold).second;
    EXPECT_LT(seen, 0.985);
    EXPECT_NEAR(corrected, 1, 0.25 * (1 - seen)) << "but for what wanders";
}

TEST_F(RigSweeps, TheDarkLibraryHoldsAllExposures) {
    open("none");
    const auto darks = measureDarks(bench());
    ASSERT_TRUE(darks) << darks.error().message;
    EXPECT_EQ(static_cast<int>(darks->size()), storedDarkSteps(bench()));
    EXPECT_GE(darks->size(), profile.exposures.size());
    for (const proc::DarkFrame& dark : *darks) {
        EXPECT_EQ(dark.frames, 32);
        EXPECT_NEAR(dark.varianceOfMean, (2.4 * 2.4 / 2.6 / 2.6 + 1.0 / 12) / 32, 0.004);
    }
}

}  // namespace
}  // namespace gonio::daemon
