#include "driver/frame_plan.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/driver/wire_frames.h"

namespace gonio::driver {
namespace {

const FramePlan kPlan{.window = {.x = 16, .y = 8, .size = {8, 6}, .binning = 2},
                      .format = PixelFormat::Mono12Packed,
                      .led = 2,
                      .levels = LedLevels::only(Band::G, 40000),
                      .exposure = {Microseconds(1000), Nanoseconds(1004260)},
                      .gain = 600,
                      .effectiveFrame = 7,
                      .bitDepth = 12};

WireFrame asPlanned() {
    return {.captureId = 0x50001,
            .index = 3,
            .leader = {.width = 4,
                       .height = 3,
                       .stride = 6,
                       .format = PixelFormat::Mono12Packed,
                       .led = 2,
                       .channels = 2,
                       .bitDepth = 12,
                       .exposureRequestedUs = 1000,
                       .exposureGrantedNs = 1004260,
                       .gain = 600,
                       .ledLevel = {0, 40000, 0},
                       .temperature = {2600, 2900, kNoTemperature, -150},
                       .blackLevel = 60,
                       .x = 16,
                       .y = 8,
                       .binning = 2,
                       .frameBytes = 18,
                       .exposureStartUs = 1234567,
                       .frameNumber = 7},
            .trailer = {.frameBytes = 18,
                        .frameCrc = 0,
                        .exposureEndUs = 1235571,
                        .currentMin = {0, 2120, 0},
                        .currentMax = {0, 2140, 0},
                        .validity = validity::kAll,
                        .saturatedPixels = 5},
            .bytes = packPixels(test::picture({4, 3}, 1), PixelFormat::Mono12Packed)};
}

std::string whyNot(const WireFrame& wire) {
    const auto verdict = judge(wire, kPlan);
    const auto* rejected = std::get_if<Rejected>(&verdict);
    return rejected ? rejected->why : "accepted";
}

TEST(FramePlan, AcceptsAFrameThatIsWhatWasPlanned) {
    const auto verdict = judge(asPlanned(), kPlan);
    const auto* frame = std::get_if<Frame>(&verdict);
    ASSERT_NE(frame, nullptr);
    EXPECT_EQ(frame->pixels, test::picture({4, 3}, 1));
    EXPECT_EQ(frame->captureId, 0x50001U);
    EXPECT_EQ(frame->index, 3);
    EXPECT_EQ(frame->number, 7U);
    EXPECT_EQ(frame->led, 2);
    EXPECT_EQ(frame->levels, kPlan.levels);
    EXPECT_EQ(frame->exposure, kPlan.exposure);
    EXPECT_DOUBLE_EQ(frame->gainDb, 6.0);
    EXPECT_EQ(frame->window, kPlan.window);
    EXPECT_EQ(frame->blackLevel, 60);
    EXPECT_DOUBLE_EQ(*frame->celsius[1], 29.0);
    EXPECT_FALSE(frame->celsius[2]) << "no sensor";
    EXPECT_DOUBLE_EQ(*frame->celsius[3], -1.5);
    EXPECT_DOUBLE_EQ(frame->currentMinMilliamp[1], 212.0);
    EXPECT_DOUBLE_EQ(frame->currentMaxMilliamp[1], 214.0);
    EXPECT_EQ(frame->saturatedPixels, 5U);
    EXPECT_EQ(frame->start, Microseconds(1234567));
}

TEST(FramePlan, RejectsEveryFieldThatIsNotAsPlanned) {
    const auto because = [](auto change) {
        WireFrame wire = asPlanned();
        change(wire);
        return whyNot(wire);
    };
    EXPECT_EQ(because([](WireFrame& w) { w.leader.led = 1; }), "LEADER led 1, planned 2");
    EXPECT_EQ(because([](WireFrame& w) { w.leader.width = 8; }), "LEADER width 8, planned 4");
    EXPECT_EQ(because([](WireFrame& w) { w.leader.height = 2; }), "LEADER height 2, planned 3");
    EXPECT_EQ(because([](WireFrame& w) { w.leader.stride = 8; }), "LEADER stride 8, planned 6");
    EXPECT_EQ(because([](WireFrame& w) { w.leader.format = PixelFormat::Mono16; }),
              "LEADER pixel_format 2, planned 1");
    EXPECT_EQ(because([](WireFrame& w) { w.leader.x = 0; }), "LEADER x 0, planned 16");
    EXPECT_EQ(because([](WireFrame& w) { w.leader.y = 0; }), "LEADER y 0, planned 8");
    EXPECT_EQ(because([](WireFrame& w) { w.leader.binning = 1; }), "LEADER binning 1, planned 2");
    EXPECT_EQ(because([](WireFrame& w) { w.leader.bitDepth = 10; }),
              "LEADER bit_depth 10, planned 12");
    EXPECT_EQ(because([](WireFrame& w) { w.leader.frameBytes = 17; }),
              "LEADER frame_bytes 17, planned 18");
    EXPECT_EQ(because([](WireFrame& w) { w.leader.channels = 3; }), "LEADER channels 3, planned 2");
    EXPECT_EQ(because([](WireFrame& w) { w.leader.ledLevel[1] = 39999; }),
              "LEADER led_level 39999, planned 40000");
    EXPECT_EQ(because([](WireFrame& w) { w.leader.exposureRequestedUs = 1; }),
              "LEADER exposure_requested_us 1, planned 1000");
    EXPECT_EQ(because([](WireFrame& w) { ++w.leader.exposureGrantedNs; }),
              "LEADER exposure_granted_ns 1004261, planned 1004260");
    EXPECT_NE(because([](WireFrame& w) {
                  w.leader.exposureGrantedNs = std::numeric_limits<std::uint64_t>::max();
              }),
              "accepted");
    EXPECT_EQ(because([](WireFrame& w) { w.leader.gain = 0; }), "LEADER gain 0, planned 600");
}

TEST(FramePlan, RejectsAFrameThatLacksAnyValidityBit) {
    for (std::uint16_t bit : {validity::kInterlock, validity::kCurrent, validity::kTemperature}) {
        WireFrame wire = asPlanned();
        wire.trailer.validity = static_cast<std::uint16_t>(validity::kAll & ~bit);
        EXPECT_TRUE(whyNot(wire).starts_with("TRAILER")) << bit;
    }
}

TEST(FramePlan, FrameFromBeforeTheSettingsIsEarly) {
    WireFrame wire = asPlanned();
    wire.leader.frameNumber = 6;
    wire.leader.led = 0;  // the old value, which is nobody's fault
    EXPECT_TRUE(std::holds_alternative<Early>(judge(wire, kPlan)));
}

TEST(FramePlan, FrameNumbersWrap) {
    FramePlan plan = kPlan;
    plan.effectiveFrame = 0xFFFFFFFF;
    WireFrame wire = asPlanned();
    wire.leader.frameNumber = 2;
    EXPECT_TRUE(std::holds_alternative<Frame>(judge(wire, plan)));
    wire.leader.frameNumber = 0xFFFFFFFE;
    EXPECT_TRUE(std::holds_alternative<Early>(judge(wire, plan)));
}

TEST(FramePlan, BytesOfAFrameFollowWindowAndFormat) {
    const Window odd{.x = 0, .y = 0, .size = {3, 2}, .binning = 1};
    EXPECT_EQ(frameBytes(odd, PixelFormat::Mono12Packed), 10U);
    EXPECT_EQ(frameBytes(odd, PixelFormat::Mono16), 12U);
    EXPECT_EQ(frameBytes({.size = {1024, 1024}, .binning = 1}, PixelFormat::Mono12Packed),
              1572864U);
    EXPECT_FALSE(frameBytes({.size = {0, 2}, .binning = 1}, PixelFormat::Mono16));
    EXPECT_FALSE(frameBytes({.size = {2, -2}, .binning = 1}, PixelFormat::Mono16));
    EXPECT_FALSE(frameBytes({.size = {2, 2}, .binning = 4}, PixelFormat::Mono16));
    EXPECT_FALSE(frameBytes({.size = {2, 2}, .binning = 0}, PixelFormat::Mono16));
    EXPECT_FALSE(frameBytes({.size = {65535, 65535}, .binning = 1}, PixelFormat::Mono16));
    EXPECT_FALSE(frameBytes(odd, static_cast<PixelFormat>(9)));
}

}  // namespace
}  // namespace gonio::driver
