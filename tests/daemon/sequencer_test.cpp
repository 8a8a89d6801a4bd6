// Brackets on the simulated rig, in virtual time.

#include "daemon/sequencer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "daemon/measurement.h"
#include "proc/models/spec.h"
#include "sim/in_process.h"

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
    std::vector<Frame> bracket(const BracketPlan& plan) {
        Sequencer sequencer(*rig, profile, nextPlanStep);
        auto frames = sequencer.bracket({.led = 1, .band = Band::G}, plan);
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

TEST_F(SequencerOnSim, BracketReachesAsFarAsItWasTold) {
    place("lambert,albedo=0.001");
    const auto longestOf = [](const std::vector<Frame>& frames) {
        return std::max_element(frames.begin(),
                                frames.end(),
                                [](const auto& a, const auto& b) {
                                    return a.exposure.requested < b.exposure.requested;
                                })
            ->exposure.requested;
    };
    EXPECT_EQ(longestOf(bracket({})), profile.exposures.back());
    EXPECT_EQ(longestOf(bracket({.longest = 2})), profile.exposures[2]);
    EXPECT_EQ(longestOf(bracket({.longest = 99})), profile.exposures.back());
}

TEST_F(SequencerOnSim, StopsWhereEverythingIsSaturated) {
    place("lambert,albedo=0.9");
    const auto frames = bracket({});
    EXPECT_LT(frames.back().exposure.requested, profile.exposures.back());
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
    ASSERT_EQ(darks->size(), profile.exposures.size());
    EXPECT_EQ(steps, static_cast<int>(profile.exposures.size()));
    for (const proc::DarkFrame& dark : *darks) EXPECT_EQ(dark.frames, 2);
}

TEST_F(SequencerOnSim, MoreEffortTakesMoreFrames) {
    place("lambert,albedo=0.2");
    const std::size_t draft = bracket(sampleBracket(Effort::Draft)).size();
    const std::size_t standard = bracket(sampleBracket(Effort::Standard)).size();
    const std::size_t reference = bracket(sampleBracket(Effort::Reference)).size();
    EXPECT_LE(draft, standard);
    EXPECT_EQ(reference, 8 * standard);
}

TEST_F(SequencerOnSim, OpenInterlockIsADeviceError) {
    door.device().setInterlock(0);
    Sequencer sequencer(*rig, profile, nextPlanStep);
    const auto frames = sequencer.bracket({.led = 0, .band = Band::R}, {});
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
