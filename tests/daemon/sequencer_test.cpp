// Brackets on the simulated rig, in virtual time.

#include "daemon/sequencer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "daemon/measurement.h"
#include "proc/models/spec.h"
#include "sim/in_process.h"
#include "tests/daemon/bracket_of.h"

namespace gonio::daemon {
namespace {

class SequencerOnSim : public testing::Test {
protected:
    void SetUp() override {
        auto known = readProfile(defaultProfile());
        ASSERT_TRUE(known) << known.error().message;
        profile = std::move(*known);
        auto opened = driver::Rig::open(door, 7);
        ASSERT_TRUE(opened) << opened.error().message;
        rig.emplace(std::move(*opened));
        ASSERT_TRUE(rig->configure({.x = 384, .y = 256, .size = {512, 512}}));
    }
    void place(const std::string& spec) {
        auto model = proc::makeModel(spec);
        ASSERT_TRUE(model) << model.error().message;
        door.device().place({.role = sim::Role::Sample, .surface = std::move(*model), .wedge = {}});
    }
    double secondsOnRig() const { return Seconds(door.clock().now()).count(); }
    std::vector<Frame> bracket(const BracketPlan& plan) {
        Sequencer sequencer(*rig, profile, nextPlanStep);
        auto frames = test::bracketOf(sequencer, {.led = 1, .band = Band::G}, plan);
        EXPECT_TRUE(frames) << frames.error().message;
        return std::move(*frames);
    }

    RigProfile profile;
    sim::InProcessDoor door{{}};
    std::optional<driver::Rig> rig;
    std::uint64_t nextPlanStep = 1;
};

bool hasUnsaturated(const std::vector<Frame>& frames) {
    return std::any_of(frames.begin(), frames.end(), [](const Frame& frame) {
        return frame.saturatedPixels == 0;
    });
}

TEST_F(SequencerOnSim, StatesAreLedsByBands) {
    const Sequencer sequencer(*rig, profile, nextPlanStep);
    const auto states = sequencer.states();
    ASSERT_EQ(states.size(), 12U);
    EXPECT_EQ(states[5].led, 1);
    EXPECT_EQ(states[5].band, Band::B);
}

TEST_F(SequencerOnSim, DarkSampleNeedsNoDimLight) {
    place("lambert,albedo=0.01");
    for (const Frame& frame : bracket({})) {
        EXPECT_EQ(frame.levels, LedLevels::only(Band::G, 65535));
        EXPECT_EQ(frame.led, 1);
        EXPECT_GE(frame.exposure.requested, profile.exposures[1]);
    }
}

TEST_F(SequencerOnSim, SharpLobeIsDimmedUntilNothingSaturates) {
    place("ggx,alpha=0.02,f0=0.9");
    const auto dimmed = bracket({});
    EXPECT_TRUE(hasUnsaturated(dimmed));
    EXPECT_TRUE(std::any_of(dimmed.begin(), dimmed.end(), [](const Frame& frame) {
        return frame.levels[Band::G] < 65535;
    }));
    EXPECT_FALSE(hasUnsaturated(bracket({.dim = false})));
}

Microseconds longestOf(const std::vector<Frame>& frames) {
    Microseconds longest{0};
    for (const Frame& frame : frames) longest = std::max(longest, frame.exposure.requested);
    return longest;
}

TEST_F(SequencerOnSim, BracketReachesAsFarAsItWasTold) {
    place("lambert,albedo=0.001");
    EXPECT_EQ(longestOf(bracket({})), profile.exposures.back());
    EXPECT_EQ(longestOf(bracket({.longest = 2})), profile.exposures[2]);
    EXPECT_EQ(longestOf(bracket({.longest = 99})), profile.exposures.back());
}

TEST_F(SequencerOnSim, StopsWhereEverythingIsSaturated) {
    place("lambert,albedo=0.9");
    EXPECT_LT(longestOf(bracket({})), profile.exposures.back());
}

TEST_F(SequencerOnSim, ABracketTakesAFramePeriodPerCapture) {
    place("lambert,albedo=0.001");
    Sequencer sequencer(*rig, profile, nextPlanStep);
    const double begin = secondsOnRig();
    constexpr int kStates = 3;
    for (int led = 0; led < kStates; ++led) {
        const auto then = led + 1 < kStates ? std::optional(State{.led = led + 1, .band = Band::G})
                                            : std::nullopt;
        const auto frames = test::bracketOf(sequencer, {.led = led, .band = Band::G}, {}, then);
        ASSERT_TRUE(frames) << frames.error().message;
        ASSERT_EQ(frames->size(), 5U);
        for (const Frame& frame : *frames) EXPECT_EQ(frame.led, led);
    }
    // Four periods of 40 ms and one of 41 ms a state, settling once of 5 ms; 10 ms of transfer (a
    // quarter of the sensor) remain at the end.
    EXPECT_NEAR(secondsOnRig() - begin, kStates * 0.201 + 0.005 + 0.010, 0.010);
    EXPECT_EQ(rig->anomalies(), driver::Anomalies{});
}

TEST_F(SequencerOnSim, ArmingTheNextStateAheadChangesNoFrame) {
    place("ggx,alpha=0.05,f0=0.9/0.7/0.4");
    sim::InProcessDoor twinDoor{{}};
    twinDoor.device().place(
        {.role = sim::Role::Sample,
         .surface = std::move(*proc::makeModel("ggx,alpha=0.05,f0=0.9/0.7/0.4")),
         .wedge = {}});
    auto twinRig = driver::Rig::open(twinDoor, 7);
    ASSERT_TRUE(twinRig && twinRig->configure({.x = 384, .y = 256, .size = {512, 512}}));
    std::uint64_t twinStep = 1;
    Sequencer ahead(*rig, profile, nextPlanStep);
    Sequencer alone(*twinRig, profile, twinStep);
    const auto states = ahead.states();
    for (std::size_t i = 0; i < 6; ++i) {
        const auto seen = test::bracketOf(ahead, states[i], {}, states[i + 1]);
        const auto wanted = test::bracketOf(alone, states[i], {});
        ASSERT_TRUE(seen && wanted);
        ASSERT_EQ(seen->size(), wanted->size());
        for (std::size_t k = 0; k < seen->size(); ++k) {
            EXPECT_EQ((*seen)[k].captureId >> 16, (*wanted)[k].captureId >> 16);
            EXPECT_EQ((*seen)[k].pixels, (*wanted)[k].pixels);
        }
    }
}

TEST_F(SequencerOnSim, AnotherStateThanTheOneArmedAheadIsThatState) {
    place("lambert,albedo=0.2");
    Sequencer sequencer(*rig, profile, nextPlanStep);
    ASSERT_TRUE(test::bracketOf(sequencer, {.led = 0, .band = Band::R}, {}, State{1, Band::R}));
    const auto frames = test::bracketOf(sequencer, {.led = 2, .band = Band::B}, {});
    ASSERT_TRUE(frames) << frames.error().message;
    std::set<std::uint64_t> captures;
    for (const Frame& frame : *frames) {
        EXPECT_EQ(frame.led, 2);
        EXPECT_EQ(frame.levels[Band::R], 0);
        captures.insert(frame.captureId);
    }
    EXPECT_EQ(captures.size(), frames->size());
    const auto single = sequencer.expose({.led = 3, .band = Band::G}, 0.5, profile.exposures[0], 2);
    ASSERT_TRUE(single) << single.error().message;
    EXPECT_EQ(single->front().led, 3);
}

TEST_F(SequencerOnSim, NoTwoCapturesShareAPlanStep) {
    place("lambert,albedo=0.2");
    std::set<std::uint64_t> captures;
    std::size_t frames = 0;
    for (int i = 0; i < 2; ++i) {
        for (const Frame& frame : bracket({.frames = 2})) {
            captures.insert(frame.captureId);
            ++frames;
        }
    }
    EXPECT_EQ(captures.size() * 2, frames);
    EXPECT_EQ(nextPlanStep, captures.size() + 1);
}

TEST_F(SequencerOnSim, DarksCoverTheLadder) {
    Sequencer sequencer(*rig, profile, nextPlanStep);
    int steps = 0;
    const auto darks = sequencer.darks(2, [&]() -> Result<void> {
        ++steps;
        return {};
    });
    ASSERT_TRUE(darks) << darks.error().message;
    EXPECT_EQ(darks->size(), profile.exposures.size());
    EXPECT_EQ(steps, static_cast<int>(profile.exposures.size()));
}

TEST_F(SequencerOnSim, KnownShotsComeInTheirOrderOnePeriodApart) {
    place("lambert,albedo=0.2");
    Sequencer sequencer(*rig, profile, nextPlanStep);
    const std::vector<KnownShot> shots{
        {.state = State{1, Band::G}, .shot = {.level = 1, .exposure = profile.exposures[1]}},
        {.state = {}, .shot = {.exposure = profile.exposures[0]}, .frames = 3},
        {.state = State{2, Band::B}, .shot = {.level = 0.5, .exposure = profile.exposures[0]}}};
    std::vector<std::pair<std::size_t, std::optional<int>>> seen;
    std::vector<std::size_t> done;
    const double begin = secondsOnRig();
    const auto taken =
        sequencer.take(shots,
                       {.frame = [&](std::size_t shot, const Frame& frame) -> Result<void> {
                            seen.emplace_back(shot, frame.led);
                            return {};
                        },
                        .done = [&](std::size_t shot) -> Result<void> {
                            done.push_back(shot);
                            return {};
                        }});
    ASSERT_TRUE(taken) << taken.error().message;
    const std::vector<std::pair<std::size_t, std::optional<int>>> wanted{
        {0, 1}, {1, std::nullopt}, {1, std::nullopt}, {1, std::nullopt}, {2, 2}};
    EXPECT_EQ(seen, wanted);
    EXPECT_EQ(done, (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_LT(secondsOnRig() - begin, 5 * 0.040 + 0.030);
    const auto ended =
        sequencer.take(shots,
                       {.frame = [](std::size_t, const Frame&) { return Result<void>(); },
                        .done = [](std::size_t shot) -> Result<void> {
                            if (shot < 1) return {};
                            return Error{ErrorKind::Interrupted, "cancelled"};
                        }});
    ASSERT_FALSE(ended);
    EXPECT_EQ(ended.error().kind, ErrorKind::Interrupted);
}

TEST_F(SequencerOnSim, OpenInterlockIsADeviceError) {
    door.device().setInterlock(0);
    Sequencer sequencer(*rig, profile, nextPlanStep);
    const auto frames = test::bracketOf(sequencer, {.led = 0, .band = Band::R}, {});
    ASSERT_FALSE(frames);
    EXPECT_EQ(frames.error().kind, ErrorKind::Device);
    EXPECT_EQ(frames.error().deviceStatus, driver::status::kInterlock);
}

TEST_F(SequencerOnSim, WindowIsTheSquareInTheMiddle) {
    const auto window = configureWindow(*rig);
    ASSERT_TRUE(window) << window.error().message;
    EXPECT_EQ(*window, (Window{.x = 128, .y = 0, .size = {1024, 1024}, .binning = 1}));
}

TEST(CheckWhite, RefusesBlackInItsPlace) {
    auto signal = proc::CellSignal::missing(3);
    for (std::size_t cell = 0; cell < 3; ++cell) {
        signal.signal[cell] = 1000;
        signal.flags[cell] = Flags{Flag::Measured};
    }
    const PlacementSignals white{{signal, signal, signal}};
    for (double& s : signal.signal) s = 1;
    const PlacementSignals black{{signal, signal, signal}};
    EXPECT_TRUE(checkWhite(white, black));
    const auto refused = checkWhite(black, black);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Quality);
    EXPECT_NE(refused.error().message.find("LED 0 r"), std::string::npos);
}

}  // namespace
}  // namespace gonio::daemon
