// Whole placements on the simulated rig, in virtual time.

#include "daemon/measurement.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "driver/steady_clock.h"
#include "proc/models/spec.h"
#include "proc/radiance/merge.h"
#include "sim/in_process.h"
#include "sim/optics.h"
#include "sim/rig_errors.h"
#include "tests/daemon/bracket_of.h"
#include "tests/optics/lenses.h"

namespace gonio::daemon {
namespace {

constexpr int kDarkFrames = 2;
const BracketPlan kPlan{.longest = 2};

class MeasurementOnSim : public testing::Test {
protected:
    void SetUp() override {
        auto known = readProfile(defaultProfile());
        ASSERT_TRUE(known) << known.error().message;
        profile = std::move(*known);
        door.device().place({.role = sim::Role::Sample,
                             .surface = std::move(*proc::makeModel("ggx,alpha=0.2,f0=0.5")),
                             .wedge = {}});
        auto opened = driver::Rig::open(door, 7);
        ASSERT_TRUE(opened) << opened.error().message;
        rig.emplace(std::move(*opened));
    }
    Result<Captured> measured(std::function<Result<void>(const std::string&)> step) {
        return measurePlacement({.rig = *rig,
                                 .profile = profile,
                                 .nextPlanStep = nextPlanStep,
                                 .clock = computer,
                                 .step = std::move(step)},
                                gonio::test::crookedLens(),
                                kPlan,
                                kDarkFrames);
    }
    [[nodiscard]] bool dark() {
        const auto status = driver::decodeStatus(*door.device().getFeature(0x10));
        return status && status->ledOn == 0 && status->state == driver::RigState::Idle;
    }

    RigProfile profile;
    driver::SteadyClock computer;
    sim::InProcessDoor door{{}};
    std::optional<driver::Rig> rig;
    std::uint64_t nextPlanStep = 1;
};

void expectSameBits(const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_EQ(std::bit_cast<std::uint64_t>(a[i]), std::bit_cast<std::uint64_t>(b[i])) << i;
}

TEST_F(MeasurementOnSim, MergingBesideTheCapturesChangesNoBit) {
    std::vector<std::string> steps;
    const auto seen = measured([&](const std::string& what) -> Result<void> {
        steps.push_back(what);
        return {};
    });
    ASSERT_TRUE(seen) << seen.error().message;
    EXPECT_TRUE(dark());
    EXPECT_EQ(steps.size(), profile.exposures.size() + 12);
    EXPECT_EQ(steps.back(), "LED 3 b");
    EXPECT_GT(seen->compute.count(), 0);
    ASSERT_EQ(seen->raw.states.size(), 12U);
    EXPECT_TRUE(seen->lightSteps.empty()) << described(seen->lightSteps);

    // One after the other, on a rig like it.
    sim::InProcessDoor twinDoor{{}};
    twinDoor.device().place({.role = sim::Role::Sample,
                             .surface = std::move(*proc::makeModel("ggx,alpha=0.2,f0=0.5")),
                             .wedge = {}});
    auto twin = driver::Rig::open(twinDoor, 7);
    ASSERT_TRUE(twin);
    const auto window = configureWindow(*twin);
    ASSERT_TRUE(window);
    std::uint64_t step = 1;
    Sequencer sequencer(*twin, profile, step);
    const auto darks = sequencer.darks(kDarkFrames, [] { return Result<void>(); });
    ASSERT_TRUE(darks);
    const proc::Binning binning(gonio::test::crookedLens(), *window, kField);
    std::size_t at = 0;
    for (const State state : sequencer.states()) {
        const auto frames = test::bracketOf(sequencer, state, kPlan);
        ASSERT_TRUE(frames);
        const auto merged = proc::merge(*frames, state.band, *darks, profile.noise);
        ASSERT_TRUE(merged);
        const proc::CellSignal wanted = binning.bin(*merged);
        const proc::CellSignal& signal =
            seen->signals[static_cast<std::size_t>(state.led)][index(state.band)];
        expectSameBits(signal.signal, wanted.signal);
        expectSameBits(signal.variance, wanted.variance);
        const proc::RawState& raw = seen->raw.states[at++];
        EXPECT_EQ(raw.merged.led, state.led);
        EXPECT_EQ(raw.merged.band, state.band);
        EXPECT_EQ(raw.merged.chiSquare, merged->chiSquare);
        EXPECT_EQ(raw.bracket.size(), frames->size());
    }
}

TEST_F(MeasurementOnSim, CancellingAtAnyKindOfStepLeavesTheRigDarkAndUsable) {
    // A dark exposure, the first state (the next is armed ahead by then), one with another merging.
    for (const int last : {1, 7, 8}) {
        SCOPED_TRACE("step " + std::to_string(last));
        int steps = 0;
        const auto cancelled = measured([&](const std::string&) -> Result<void> {
            if (++steps < last) return {};
            return Error{ErrorKind::Interrupted, "cancelled"};
        });
        ASSERT_FALSE(cancelled);
        EXPECT_EQ(cancelled.error().kind, ErrorKind::Interrupted);
        EXPECT_EQ(steps, last);
        EXPECT_TRUE(dark());
    }
    const auto capture = rig->capture({.planStep = nextPlanStep++, .exposure = Microseconds(100)});
    EXPECT_TRUE(capture) << capture.error().message;
    EXPECT_EQ(rig->anomalies(), driver::Anomalies{});
}

/// All states of a glossy sample on a rig with these errors.
Result<Captured> capturedWith(const std::string& rigErrors) {
    const auto errors = sim::parseRigErrors(rigErrors, {});
    if (!errors) return errors.error();
    const auto profile = readProfile(defaultProfile());
    if (!profile) return profile.error();
    sim::InProcessDoor door({.rig = *errors});
    door.device().place({.role = sim::Role::Sample,
                         .surface = std::move(*proc::makeModel("ggx,alpha=0.2,f0=0.5")),
                         .wedge = {}});
    auto rig = driver::Rig::open(door, 7);
    if (!rig) return rig.error();
    const driver::SteadyClock computer;
    std::uint64_t nextPlanStep = 1;
    return measurePlacement({.rig = *rig,
                             .profile = *profile,
                             .nextPlanStep = nextPlanStep,
                             .clock = computer,
                             .step = [](const std::string&) { return Result<void>(); }},
                            gonio::test::crookedLens(),
                            {.longest = 4},
                            kDarkFrames);
}

TEST(LightOnSim, AStepOfFivePerCentInABracketIsFlaggedThereAndNowhereElse) {
    const auto seen = capturedWith("step=-0.05@20");
    ASSERT_TRUE(seen) << seen.error().message;
    ASSERT_EQ(seen->lightSteps.size(), 1U) << described(seen->lightSteps);
    const LightStep& step = seen->lightSteps.front();
    EXPECT_NEAR(step.change.offset.size, -0.05, 0.01);
    EXPECT_NE(described(seen->lightSteps).find("darker than the other"), std::string::npos)
        << described(seen->lightSteps);
}

TEST(LightOnSim, WhatIsUsuallyWrongWithARigIsNoStep) {
    const auto seen = capturedWith("typical");
    ASSERT_TRUE(seen) << seen.error().message;
    EXPECT_TRUE(seen->lightSteps.empty()) << described(seen->lightSteps);
}

/// Root mean square of the map's errors over the disc to 75 degrees, each square pixel alike.
double rmsDegrees(const proc::LensMap& map, const sim::Optics& truth) {
    double squares = 0, area = 0;
    for (double theta = 2.5; theta <= 75; theta += 2.5) {
        for (double phi = 0; phi < 360; phi += 15) {
            const Direction wo =
                Direction::fromSpherical(Radians::fromDegrees(theta), Radians::fromDegrees(phi));
            const sim::ImagePoint at = truth.pixelOf(wo);
            const auto seen = map.directionAt({at.x, at.y});
            EXPECT_TRUE(seen);
            if (seen) squares += theta * std::pow(angleBetween({wo, *seen}).degrees(), 2);
            area += theta;
        }
    }
    return std::sqrt(squares / area);
}

TEST(LensOnSim, IsRightTo0Point02DegreesOverTheDiscOnWedgesThatAreOff) {
    auto profile = readProfile(defaultProfile());
    ASSERT_TRUE(profile) << profile.error().message;
    const auto errors = sim::parseRigErrors("typical", {});
    ASSERT_TRUE(errors);
    double squares = 0;
    std::vector<std::string> serials{"SIM-0001"};
    if (std::getenv("GONIO_NIGHTLY") != nullptr) serials.emplace_back("SIM-0004");
    for (const std::string& serial : serials) {
        sim::InProcessDoor door({.serial = serial, .seed = 7, .rig = *errors});
        auto rig = driver::Rig::open(door, 7);
        ASSERT_TRUE(rig) << rig.error().message;
        const driver::SteadyClock computer;
        std::uint64_t nextPlanStep = 1;
        const auto lens =
            measureLens({.rig = *rig,
                         .profile = *profile,
                         .nextPlanStep = nextPlanStep,
                         .clock = computer,
                         .step = [](const std::string&) { return Result<void>(); }},
                        [&](const proc::Wedge& wedge) -> Result<void> {
                            door.device().place({.role = sim::Role::Mirror,
                                                 .surface = nullptr,
                                                 .wedge = {wedge.aboutX, wedge.aboutY}});
                            return {};
                        });
        ASSERT_TRUE(lens) << lens.error().message;
        const double rms = rmsDegrees(lens->fit.map, sim::Optics(serial, {640, 512}));
        std::cout << serial << ": " << lens->spots << " spots, " << lens->fit.rmsPixels
                  << " px rms, " << rms << " degrees rms over the disc\n";
        squares += rms * rms;
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(serials.size())), 0.02);
}

}  // namespace
}  // namespace gonio::daemon
