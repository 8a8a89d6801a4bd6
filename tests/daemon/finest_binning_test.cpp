// A rig that sends binned pictures only is measured with those.

#include "daemon/finest_binning.h"

#include <gtest/gtest.h>

#include "daemon/capture_plan.h"
#include "daemon/measurement.h"
#include "sim/in_process.h"

namespace gonio::daemon {
namespace {

constexpr std::uint64_t kSession = 7;

/// A simulated rig in this process.
struct Opened {
    explicit Opened(std::uint8_t binnings) : door({.seed = 3, .errors = {}, .binnings = binnings}) {
        auto opened = driver::Rig::open(door, kSession);
        EXPECT_TRUE(opened) << opened.error().message;
        if (opened) rig.emplace(std::move(*opened));
    }
    sim::InProcessDoor door;
    std::optional<driver::Rig> rig;
};

TEST(FinestBinning, IsTheLeastThatTheRigNames) {
    EXPECT_EQ(finestBinning({.binnings = 0b111}), 1);
    EXPECT_EQ(finestBinning({.binnings = 0b110}), 2);
    EXPECT_EQ(finestBinning({.binnings = 0b100}), 4);
    EXPECT_EQ(finestBinning({.binnings = 0}), 1);
    EXPECT_EQ(finestBinning({.binnings = 0b1000}), 1) << "reserved bits say nothing";
}

TEST(FinestBinning, APlainRigIsReadPixelByPixel) {
    Opened plain(sim::kAllBinnings);
    ASSERT_TRUE(plain.rig);
    const auto window = configureWindow(*plain.rig);
    ASSERT_TRUE(window) << window.error().message;
    EXPECT_EQ(window->binning, 1);
}

TEST(FinestBinning, ACoarseRigIsReadBinnedAndSendsNothingElse) {
    Opened coarse(sim::kCoarsestBinning);
    ASSERT_TRUE(coarse.rig);
    const auto window = configureWindow(*coarse.rig);
    ASSERT_TRUE(window) << window.error().message;
    EXPECT_EQ(window->binning, 4);
    EXPECT_EQ(window->size, (Size{1024, 1024}));
    const auto dark = coarse.rig->capture({.planStep = 1, .exposure = Microseconds(320)});
    ASSERT_TRUE(dark) << dark.error().message;
    EXPECT_EQ(dark->front().pixels.size(), (Size{256, 256}));
    for (const int finer : {1, 2}) {
        const auto refused = coarse.rig->configure({.size = {1024, 1024}, .binning = finer});
        ASSERT_FALSE(refused) << finer;
        EXPECT_EQ(refused.error().deviceStatus, 101) << refused.error().message;  // BAD_ARG
    }
}

/// The noise of a mean over `members`, in DN, is that of one pixel by their root.
TEST(FinestBinning, ThePlannerCountsTheElectronsOfAllMembers) {
    const auto profile = readProfile(defaultProfile());
    ASSERT_TRUE(profile) << profile.error().message;
    driver::RigInfo info;
    info.limits.binnings = 0b111;
    info.maxFrames = 256;
    const proc::SensorModel one = rigModel(info, *profile, 25).sensor;
    info.limits.binnings = 0b100;
    const proc::SensorModel binned = rigModel(info, *profile, 25).sensor;
    constexpr double kMembers = 16, kElectrons = 4000, kSeconds = 0.01;
    const auto analogue = [](const proc::SensorNoise& noise, double electrons) {
        const double k = noise.electronsPerDn;
        return (noise.variance(electrons, kSeconds) - k * k / 12) / (k * k);
    };
    EXPECT_NEAR(analogue(binned.noise, kMembers * kElectrons),
                analogue(one.noise, kElectrons) / kMembers,
                1e-12);
    EXPECT_EQ(binned.fullWellElectrons, kMembers * one.fullWellElectrons);
    EXPECT_EQ(binned.noise.fullScaleDn, one.noise.fullScaleDn);
}

}  // namespace
}  // namespace gonio::daemon
