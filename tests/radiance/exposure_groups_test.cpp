#include "proc/radiance/exposure_groups.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "tests/radiance/frames.h"

namespace gonio::proc {
namespace {

constexpr Size kSize{4, 4};

std::vector<Frame> bracketOf(const std::vector<test::Shot>& shots) {
    std::mt19937_64 random(1);
    std::vector<Frame> frames;
    for (const test::Shot& shot : shots) {
        frames.push_back(test::take(shot, kSize, random));
        frames.back().number = static_cast<std::uint32_t>(frames.size());
    }
    return frames;
}

DarkLibrary darksOf(const std::vector<double>& seconds) {
    DarkLibrary library;
    for (double s : seconds) {
        library.add(
            averageDark(bracketOf({{.seconds = s, .level = 0}, {.seconds = s, .level = 0}}), {})
                .value());
    }
    return library;
}

TEST(ExposureGroups, HoldEachFrameOnceWithThoseTakenAlike) {
    const std::vector<Frame> bracket = bracketOf({{.seconds = 2e-3},
                                                  {.seconds = 1e-3},
                                                  {.seconds = 2e-3},
                                                  {.seconds = 1e-3, .level = 30000},
                                                  {.seconds = 2e-3}});
    const DarkLibrary darks = darksOf({1e-3, 2e-3});
    const auto groups = exposureGroups(bracket, Band::G, darks);
    ASSERT_TRUE(groups) << groups.error().message;
    ASSERT_EQ(groups->size(), 3U);
    std::set<const Frame*> seen;
    for (const ExposureGroup& group : *groups) {
        ASSERT_FALSE(group.frames.empty());
        ASSERT_NE(group.dark, nullptr);
        for (const Frame* frame : group.frames) {
            EXPECT_TRUE(seen.insert(frame).second);
            EXPECT_EQ(frame->exposure.granted, group.dark->exposure.granted);
            EXPECT_DOUBLE_EQ(frame->exposure.seconds(), group.seconds);
            EXPECT_DOUBLE_EQ(group.tau, group.seconds * frame->levels[Band::G] / 65535.0);
        }
    }
    EXPECT_EQ(seen.size(), bracket.size());
}

TEST(ExposureGroups, AtFullLevelTheEffectiveTimeIsTheExposure) {
    const auto bracket = bracketOf({{.seconds = 1e-3}});
    const DarkLibrary darks = darksOf({1e-3});
    const auto groups = exposureGroups(bracket, Band::G, darks);
    ASSERT_TRUE(groups);
    EXPECT_EQ(groups->front().tau, groups->front().seconds);
}

TEST(ExposureGroups, SayWhichFrameDoesNotBelong) {
    const DarkLibrary darks = darksOf({1e-3});
    const auto complaint = [&](auto change) {
        std::vector<Frame> bracket = bracketOf({{.seconds = 1e-3}, {.seconds = 1e-3}});
        change(bracket[1]);
        const auto groups = exposureGroups(bracket, Band::G, darks);
        if (groups) return std::string("taken");
        EXPECT_EQ(groups.error().kind, ErrorKind::Quality);
        return groups.error().message;
    };
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    EXPECT_EQ(complaint([](Frame&) {}), "taken");
    EXPECT_TRUE(has(complaint([](Frame& f) { f.led.reset(); }), "frame 2 was not lit in band g"));
    EXPECT_TRUE(has(complaint([](Frame& f) { f.levels.value[0] = 1; }), "more than band g"));
    EXPECT_TRUE(has(complaint([](Frame& f) { f.led = 3; }), "LED 1 and LED 3"));
    EXPECT_TRUE(has(complaint([](Frame& f) { f.window.x = 8; }), "another window"));
    EXPECT_TRUE(has(complaint([](Frame& f) { f.gainDb = 6; }), "another gain"));
    EXPECT_TRUE(has(complaint([](Frame& f) { f.exposure.granted = {}; }), "no exposure time"));
    EXPECT_TRUE(has(complaint([](Frame& f) { f.exposure.granted *= 2; }), "merge: "));
    EXPECT_FALSE(exposureGroups({}, Band::G, darks));
}

}  // namespace
}  // namespace gonio::proc
