#include "daemon/frame_watch.h"

#include <gtest/gtest.h>

#include <random>

#include "proc/optics/cell_grid.h"
#include "tests/radiance/frames.h"

namespace gonio::daemon {
namespace {

constexpr Size kSize{64, 64};
constexpr State kState{1, Band::G};
constexpr gonio::test::Shot kLit{.electronsPerSecond = 1e6, .seconds = 1e-3},
    kNoLight{.seconds = 1e-3};

class FrameWatchTest : public testing::Test {
protected:
    void SetUp() override {
        std::vector<Frame> dark;
        for (int i = 0; i < 8; ++i) dark.push_back(take({.seconds = 1e-3, .level = 0}));
        auto mean = proc::averageDark(dark, noise);
        ASSERT_TRUE(mean) << mean.error().message;
        darks.add(std::move(*mean));
    }
    Frame take(const gonio::test::Shot& shot) {
        Frame frame = gonio::test::take(shot, kSize, random);
        frame.number = ++number;
        return frame;
    }
    proc::SensorNoise noise;
    proc::DarkLibrary darks;
    std::mt19937_64 random{4};
    std::uint32_t number = 100;
    /// 3e4 electrons in a frame: 1e-4 of it are 3, and u is 0.04.
    const WhiteRates white{{3e7, 3e7, 3e7}, {3e7, 3e7, 3e7}};
};

TEST_F(FrameWatchTest, GoodFramesAreNotOdd) {
    FrameWatch watch(noise);
    watch.expect(darks, white);
    watch.begin();
    for (int i = 0; i < 5; ++i) EXPECT_FALSE(watch.see(kState, take(kLit)));
    EXPECT_EQ(framesVerdict({}).grade, proc::Grade::Ok);
}

TEST_F(FrameWatchTest, ARepeatedPictureIsOddAlsoInAnotherBracket) {
    FrameWatch watch(noise);
    watch.begin();
    Frame frame = take(kLit);
    ASSERT_FALSE(watch.see(kState, frame));
    frame.number = 777;
    frame.index = 1;
    const auto odd = watch.see(kState, frame);
    ASSERT_TRUE(odd);
    EXPECT_EQ(odd->kind, Setback::Cause::Repeated);
    watch.begin();
    EXPECT_TRUE(watch.see(std::nullopt, frame));
    const std::vector<OddFrame> all{*odd};
    const proc::Verdict verdict = framesVerdict(all);
    EXPECT_EQ(verdict.grade, proc::Grade::Warned);
    EXPECT_NE(verdict.evidence.find("LED 1 g: frame 777 is bit for bit"), std::string::npos)
        << verdict.evidence;
    EXPECT_FALSE(verdict.next.empty());
}

// By a simulated rig, whose noise goes by the plan: the frame before was the last sound one.
TEST_F(FrameWatchTest, TheSameFrameOfThePlanInAnotherAttemptIsNoRepeat) {
    FrameWatch watch(noise);
    watch.begin();
    Frame frame = take(kLit);
    frame.captureId = 112 << 16 | 1;
    ASSERT_FALSE(watch.see(kState, frame));
    EXPECT_TRUE(watch.see(kState, frame)) << "it came twice in one attempt";
    watch.begin();
    frame.captureId = 112 << 16 | 2;
    EXPECT_FALSE(watch.see(kState, frame));
    Frame next = frame;
    next.index = 1;
    EXPECT_TRUE(watch.see(kState, next)) << "another frame of the plan";
    next = frame;
    next.captureId = 113 << 16 | 1;
    EXPECT_TRUE(watch.see(kState, next)) << "another step of the plan";
}

TEST_F(FrameWatchTest, ALitFrameWithoutLightIsOddWhereWhiteTells) {
    FrameWatch watch(noise);
    watch.expect(darks, white);
    watch.begin();
    const auto odd = watch.see(kState, take(kNoLight));
    ASSERT_TRUE(odd);
    EXPECT_EQ(odd->kind, Setback::Cause::Unlit);
    FrameWatch without(noise);
    EXPECT_FALSE(without.see(kState, take(kNoLight))) << "nothing is known of the light";
    FrameWatch dim(noise);
    dim.expect(darks, {{300, 300, 300}, {300, 300, 300}});
    EXPECT_FALSE(dim.see(kState, take(kNoLight))) << "so little light is lost in the noise";
}

TEST_F(FrameWatchTest, TheFirstFrameIsHeldAgainstAnEarlierOneOfItsBracket) {
    FrameWatch watch(noise);
    const Frame pilot = take({.electronsPerSecond = 1e6, .seconds = 5e-4});
    Frame unlike = take({.electronsPerSecond = 4e6, .seconds = 1e-3});
    watch.begin(&pilot);
    const auto odd = watch.see(kState, unlike);
    ASSERT_TRUE(odd);
    EXPECT_EQ(odd->kind, Setback::Cause::Exposure);
    watch.begin();
    EXPECT_FALSE(watch.see(kState, unlike)) << "it may be another bracket's light";
    watch.begin(&pilot);
    EXPECT_FALSE(watch.see(kState, take(kLit)));
}

TEST(WhiteRates, SpreadTheFieldsLightOverTheWindow) {
    auto signal = proc::CellSignal::missing(proc::CellGrid::count());
    double sphere = 0;
    for (std::size_t cell = 0; cell < signal.size(); ++cell) {
        signal.signal[cell] = 7;
        signal.variance[cell] = 1;
        signal.flags[cell] = Flags{Flag::Measured};
        sphere += proc::CellGrid::solidAngle(cell);
    }
    const WhiteRates rates = whiteRates({{signal, signal, signal}}, {.size = {100, 50}});
    ASSERT_EQ(rates.size(), 1U);
    EXPECT_NEAR(rates[0][2], 7 * sphere / 5000, 1e-12);
}

}  // namespace
}  // namespace gonio::daemon
