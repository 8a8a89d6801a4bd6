#include "daemon/bracket_ladder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <set>

namespace gonio::daemon {
namespace {

constexpr Size kSize{20, 20};
constexpr double kBlack = 60, kFull = 4095;

const RigProfile& profile() {
    static const RigProfile known{.name = "test",
                                  .hash = {},
                                  .noise = {},
                                  .exposures = {Microseconds(20),
                                                Microseconds(80),
                                                Microseconds(320),
                                                Microseconds(1280),
                                                Microseconds(5120),
                                                Microseconds(40000)},
                                  .dimLevels = {0.05, 0.0025},
                                  .whiteReference = {}};
    return known;
}

/// DN per microsecond at full level, pixel by pixel.
using Scene = std::vector<double>;

Scene flat(double rate) { return Scene(kSize.pixels(), rate); }

Frame take(const Scene& scene, const Shot& shot) {
    Frame frame;
    frame.pixels = Image<std::uint16_t>(kSize);
    frame.exposure = {.requested = shot.exposure,
                      .granted = Nanoseconds(shot.exposure) + Nanoseconds(14000)};
    frame.blackLevel = static_cast<std::uint16_t>(kBlack);
    const double time = static_cast<double>(frame.exposure.granted.count()) * 1e-3;
    for (std::size_t i = 0; i < scene.size(); ++i) {
        const double dn = std::min(kFull, std::round(kBlack + scene[i] * time * shot.level));
        frame.pixels.pixels()[i] = static_cast<std::uint16_t>(dn);
        if (dn >= kFull) ++frame.saturatedPixels;
    }
    return frame;
}

struct Taken {
    std::vector<Shot> shots;
    int ahead = 0;  ///< of them chosen while another was on its way
};

/// As the sequencer does it: one shot on its way while the next is chosen.
Taken overlapped(const Scene& scene, const BracketPlan& plan) {
    BracketLadder ladder(profile(), plan);
    Taken taken;
    NextShot now = ladder.advance();
    while (now.outlook == Outlook::Shot) {
        taken.shots.push_back(now.shot);
        NextShot next = ladder.advance();
        const std::vector<Frame> frames{take(scene, now.shot)};
        ladder.seen(frames);
        if (next.outlook == Outlook::Shot) {
            ++taken.ahead;
        } else {
            next = ladder.advance();
            EXPECT_NE(next.outlook, Outlook::Unknown) << "with nothing on its way";
        }
        now = next;
    }
    return taken;
}

/// The rules one after the other, each with the last result known.
std::vector<Shot> serial(const Scene& scene, const BracketPlan& plan) {
    const auto& ladder = profile().exposures;
    const int last = static_cast<int>(ladder.size()) - 1;
    const int longest = plan.longest < 0 ? last : std::min(plan.longest, last);
    const int first = std::clamp(plan.first, 0, longest);
    std::vector<Shot> shots;
    const auto saturated = [&](const Shot& shot) {
        shots.push_back(shot);
        return take(scene, shot).saturatedPixels;
    };
    const auto rung = [&](int i) { return Shot{1, ladder[static_cast<std::size_t>(i)]}; };
    const std::uint32_t atFirst = saturated(rung(first));
    std::uint32_t now = atFirst;
    for (int i = first - 1; i >= 0 && now > 0; --i) now = saturated(rung(i));
    for (std::size_t i = 0; plan.dim && i < profile().dimLevels.size() && now > 0; ++i)
        now = saturated({profile().dimLevels[i], ladder.front()});
    now = atFirst;
    for (int i = first + 1; i <= longest && now < 0.7 * static_cast<double>(kSize.pixels()); ++i)
        now = saturated(rung(i));
    return shots;
}

bool contains(const std::vector<Shot>& shots, const Shot& shot) {
    return std::find(shots.begin(), shots.end(), shot) != shots.end();
}

TEST(BracketLadder, DarkSceneGoesUpAheadOfEachResult) {
    const Taken taken = overlapped(flat(0.001), {});
    ASSERT_EQ(taken.shots.size(), 5U);
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_EQ(taken.shots[i], (Shot{1, profile().exposures[i + 1]}));
    EXPECT_EQ(taken.ahead, 4) << "all but the first";
}

TEST(BracketLadder, StopsAheadOfTheResultThatIsForeseen) {
    // 320 us: 60 + 8 x 334 = 2732 DN; 1280 us saturates everything.
    const Taken taken = overlapped(flat(8), {});
    ASSERT_EQ(taken.shots.size(), 3U);
    EXPECT_EQ(taken.shots.back().exposure, Microseconds(1280));
    EXPECT_EQ(taken.ahead, 2);
}

TEST(BracketLadder, DownAndUpTakeTurns) {
    Scene scene = flat(0.001);
    scene[7] = 1e5;
    const Taken taken = overlapped(scene, {});
    const auto& e = profile().exposures;
    const std::vector<Shot> wanted{{1, e[1]},
                                   {1, e[2]},
                                   {1, e[0]},
                                   {1, e[3]},
                                   {0.05, e[0]},
                                   {1, e[4]},
                                   {0.0025, e[0]},
                                   {1, e[5]}};
    EXPECT_EQ(taken.shots, wanted);
    EXPECT_EQ(taken.ahead, 7);
}

TEST(BracketLadder, NextIsOverAheadOfTheLastResult) {
    BracketLadder ladder(profile(), {.longest = 2});
    const Scene scene = flat(0.001);
    const auto see = [&](const NextShot& shot) {
        const std::vector<Frame> frames{take(scene, shot.shot)};
        ladder.seen(frames);
    };
    const NextShot first = ladder.advance();
    const NextShot second = ladder.advance();
    EXPECT_EQ(second.outlook, Outlook::Shot);
    EXPECT_EQ(ladder.advance().outlook, Outlook::Unknown);
    see(first);
    EXPECT_EQ(ladder.advance().outlook, Outlook::Over);
    see(second);
    EXPECT_EQ(ladder.advance().outlook, Outlook::Over);
}

TEST(BracketLadder, OneRungIsABracket) {
    EXPECT_EQ(overlapped(flat(0.001), {.longest = 0}).shots.size(), 1U);
    EXPECT_EQ(overlapped(flat(1e6), {.dim = false, .longest = 0}).shots.size(), 1U);
    EXPECT_EQ(overlapped(flat(0.001), {.longest = 99, .first = 99}).shots.size(), 1U);
}

TEST(BracketLadder, TakesWhatTheSerialRulesTakeAndSeldomMore) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> logRate(-4, 4), spread(0, 1.5);
    int more = 0;
    constexpr int kScenes = 2000;
    for (int i = 0; i < kScenes; ++i) {
        std::normal_distribution<double> pixel(logRate(random), spread(random));
        Scene scene(kSize.pixels());
        for (double& rate : scene) rate = std::pow(10, pixel(random));
        const BracketPlan plan{.dim = random() % 2 == 0,
                               .longest = static_cast<int>(random() % 7) - 1,
                               .first = static_cast<int>(random() % 6)};
        const std::vector<Shot> wanted = serial(scene, plan);
        const std::vector<Shot> seen = overlapped(scene, plan).shots;
        for (const Shot& shot : wanted) EXPECT_TRUE(contains(seen, shot)) << "scene " << i;
        ASSERT_LE(seen.size(), wanted.size() + 1) << "scene " << i;
        more += seen.size() > wanted.size() ? 1 : 0;
        for (std::size_t k = 0; k < seen.size(); ++k)
            EXPECT_EQ(std::count(seen.begin(), seen.end(), seen[k]), 1) << "scene " << i;
    }
    // Where the first shot saturates everything already: nothing foresaw that.
    EXPECT_LT(more, kScenes / 2);
}

}  // namespace
}  // namespace gonio::daemon
