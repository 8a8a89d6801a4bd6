// What makes a bracket be taken again, and what does not.

#include "daemon/whole_brackets.h"

#include <gtest/gtest.h>

#include <random>

#include "driver/protocol/constants.h"
#include "sim/in_process.h"
#include "tests/radiance/frames.h"

namespace gonio::daemon {
namespace {

constexpr Size kSize{64, 64};
constexpr State kState{1, Band::G};
constexpr gonio::test::Shot kLit{.electronsPerSecond = 1e6, .seconds = 1e-3},
    kNoLight{.seconds = 1e-3};

class WholeBracketsOnSim : public testing::Test {
protected:
    void SetUp() override {
        auto opened = driver::Rig::open(door, 7);
        ASSERT_TRUE(opened) << opened.error().message;
        rig.emplace(std::move(*opened));
        profile.warmUp = Seconds(0);  // the rig takes no frame here
        brackets.emplace(*rig, profile, step, attendance);
    }
    Frame take(const gonio::test::Shot& shot) {
        Frame frame = gonio::test::take(shot, kSize, random);
        frame.number = ++number;
        return frame;
    }
    Result<void> look(const Frame& frame) { return brackets->look(kState, frame); }
    [[nodiscard]] std::vector<std::string> causes() const {
        std::vector<std::string> names;
        for (const Setback& one : setbacks) names.emplace_back(name(one.cause));
        return names;
    }

    sim::InProcessDoor door{{}};
    std::optional<driver::Rig> rig;
    RigProfile profile;
    std::uint64_t step = 1;
    std::vector<Setback> setbacks;
    int suspensions = 0;
    Attendance attendance{.suspended = [this](const Error&) -> Result<void> {
                              if (++suspensions < 3) return {};
                              return Error{ErrorKind::Interrupted, "cancelled"};
                          },
                          .setback = [this](const Setback& one) { setbacks.push_back(one); }};
    std::optional<WholeBrackets> brackets;
    std::mt19937_64 random{4};
    std::uint32_t number = 100;
};

TEST_F(WholeBracketsOnSim, SoundOneIsTakenOnce) {
    int attempts = 0;
    ASSERT_TRUE(brackets->take(kState, [&]() -> Result<void> {
        ++attempts;
        for (int i = 0; i < 4; ++i)
            if (auto sound = look(take(kLit)); !sound) return sound;
        return {};
    }));
    EXPECT_EQ(attempts, 1);
    EXPECT_TRUE(setbacks.empty());
    EXPECT_TRUE(brackets->oddFrames().empty());
}

TEST_F(WholeBracketsOnSim, FrameThatIsOddOnceCostsOneMoreAttempt) {
    int attempts = 0;
    const Frame first = take(kLit);
    ASSERT_TRUE(brackets->take(kState, [&]() -> Result<void> {
        ++attempts;
        if (attempts > 1) return look(take(kLit));
        if (auto sound = look(first); !sound) return sound;
        return look(first);
    }));
    EXPECT_EQ(attempts, 2);
    EXPECT_EQ(causes(), std::vector<std::string>{"repeated"});
    EXPECT_EQ(setbacks.front().bracket, "LED 1 g");
    EXPECT_NE(setbacks.front().message.find("; the bracket is taken again"), std::string::npos)
        << setbacks.front().message;
    ASSERT_EQ(brackets->oddFrames().size(), 1U);
    EXPECT_TRUE(brackets->oddFrames().front().dropped);
}

TEST_F(WholeBracketsOnSim, FrameThatIsOddTwiceIsRefusedWithItsEvidence) {
    const Frame first = take(kLit);
    const auto refused = brackets->take(kState, [&]() -> Result<void> {
        if (auto sound = look(first); !sound) return sound;
        return look(first);
    });
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Quality);
    EXPECT_NE(refused.error().message.find("frame 101 is bit for bit"), std::string::npos)
        << refused.error().message;
    EXPECT_NE(refused.error().message.find(kOddFramesCure), std::string::npos)
        << "what to do next: " << refused.error().message;
    EXPECT_NE(setbacks.back().message.find(", once more"), std::string::npos)
        << setbacks.back().message;
    EXPECT_EQ(causes(), (std::vector<std::string>{"repeated", "repeated"}));
}

TEST_F(WholeBracketsOnSim, NoPictureAnotherExposureAndAReflexAreOdd) {
    Frame blank = take(kLit);
    std::ranges::fill(blank.pixels.pixels(), std::uint16_t{60});
    Frame late = take({.electronsPerSecond = 1e6, .seconds = 2e-4});
    late.exposure.granted = std::chrono::milliseconds(1);
    Frame reflex = take(kLit);
    for (int y = 20; y < 32; ++y)
        for (int x = 20; x < 32; ++x) reflex.pixels.at(x, y) = 4095;
    for (const Frame& odd : {blank, late, reflex}) {
        int attempts = 0;
        ASSERT_TRUE(brackets->take(kState, [&]() -> Result<void> {
            if (auto sound = look(take(kLit)); !sound) return sound;
            return ++attempts == 1 ? look(odd) : Result<void>();
        }));
        EXPECT_EQ(attempts, 2);
    }
    EXPECT_EQ(causes(), (std::vector<std::string>{"blank", "exposure", "reflex"}));
}

TEST_F(WholeBracketsOnSim, BracketThatHasNoLightTwiceIsWhatLiesThere) {
    std::vector<Frame> dark;
    for (int i = 0; i < 8; ++i) dark.push_back(take({.seconds = 1e-3, .level = 0}));
    proc::DarkLibrary darks;
    darks.add(std::move(*proc::averageDark(dark, profile.noise)));
    brackets->watch().expect(darks, {{3e7, 3e7, 3e7}, {3e7, 3e7, 3e7}});
    int attempts = 0;
    ASSERT_TRUE(brackets->take(kState, [&]() -> Result<void> {
        ++attempts;
        return look(take(kNoLight));
    }));
    EXPECT_EQ(attempts, 2);
    EXPECT_EQ(causes(), (std::vector<std::string>{"unlit", "unlit"}));
    ASSERT_EQ(brackets->oddFrames().size(), 2U);
    EXPECT_TRUE(brackets->oddFrames()[0].dropped);
    EXPECT_FALSE(brackets->oddFrames()[1].dropped);
}

TEST_F(WholeBracketsOnSim, RefusalToLightIsWaitedForAsOftenAsItComes) {
    int attempts = 0;
    const auto ended = brackets->take(kState, [&]() -> Result<void> {
        ++attempts;
        const int status = attempts == 2 ? driver::status::kOverTemp : driver::status::kInterlock;
        return Error{ErrorKind::Device, "dark", status};
    });
    ASSERT_FALSE(ended);
    EXPECT_EQ(ended.error().kind, ErrorKind::Interrupted) << "who waited gave up";
    EXPECT_EQ(attempts, 3);
    EXPECT_EQ(causes(), (std::vector<std::string>{"suspended", "suspended"}));
}

TEST_F(WholeBracketsOnSim, BrokenLedAndWhateverElseEndsIt) {
    for (const int status : {int{driver::status::kLedOpen}, int{driver::status::kLedDrift}, 0}) {
        int attempts = 0;
        const auto ended = brackets->take(kState, [&]() -> Result<void> {
            ++attempts;
            return Error{ErrorKind::Device, "broken", status};
        });
        ASSERT_FALSE(ended);
        EXPECT_EQ(ended.error().deviceStatus, status);
        EXPECT_EQ(attempts, 1);
    }
    EXPECT_EQ(suspensions, 0);
}

}  // namespace
}  // namespace gonio::daemon
