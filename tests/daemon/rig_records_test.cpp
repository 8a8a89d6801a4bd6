#include "daemon/rig_records.h"

#include <gtest/gtest.h>

namespace gonio::daemon {
namespace {

constexpr Size kSize{40, 30};

TEST(RigRecords, AFlatFieldComesBackBitForBit) {
    proc::FlatField flat{.response = Image<float>(kSize, 1.0F),
                         .window = {.x = 8, .y = 16, .size = kSize},
                         .spread = 0.007,
                         .uResponse = 1e-3,
                         .coveredPixels = 0.75};
    flat.response.at(3, 4) = 0.987F;
    const auto bytes = encodeFlat(flat);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto back = decodeFlat(*bytes, "flat 3");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(**back, flat);

    flat.response.at(0, 0) = 0;
    const auto dead = decodeFlat(*encodeFlat(flat), "flat 3");
    ASSERT_FALSE(dead);
    EXPECT_EQ(dead.error().kind, ErrorKind::File);
    EXPECT_NE(dead.error().message.find("flat 3"), std::string::npos);
    EXPECT_NE(dead.error().message.find("gonio calibrate flat"), std::string::npos);
    flat.window.size = {80, 30};
    EXPECT_FALSE(decodeFlat(*encodeFlat(flat), "x")) << "a picture of another window";
}

TEST(RigRecords, LedsComeBack) {
    proc::LedMonitor leds{.fullMilliamp = {350, 351, 349.5}, .milliampStep = 0.1};
    leds.bands[1] = {
        .perKelvin = -1e-3, .uPerKelvin = 1e-5, .celsius = 27, .chiSquare = 9, .freedom = 8};
    const auto back = decodeLeds(encodeLeds(leds), "leds");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->fullMilliamp, leds.fullMilliamp);
    EXPECT_EQ(back->bands[1].perKelvin, -1e-3);
    EXPECT_EQ(back->bands[1].freedom, 8U);
}

TEST(RigRecords, ASensorComesBackAndChangesTheProfile) {
    const SensorRecord sensor{
        .transfer = {.electronsPerDn = 2.5, .uElectronsPerDn = 0.01, .readNoiseElectrons = 3},
        .linearity = {.linearity = {.blackDn = 60, .rangeDn = 4000, .coefficients = {0.1, -0.1}},
                      .inlPercent = 0.3,
                      .largestResidualDn = 0.4},
        .sweep = {{.tau = 1e-4, .meanDn = 100, .u = 0.1}},
        .celsius = 25,
        .dateUtc = "2026-01-01T00:00:00Z"};
    const auto back = decodeSensor(encodeSensor(sensor), "sensor");
    ASSERT_TRUE(back) << back.error().message;
    RigProfile plain;
    plain.hash = "0badcafe";
    const RigProfile profile = withSensor(plain, *back, 14);
    EXPECT_EQ(profile.noise.electronsPerDn, 2.5);
    EXPECT_EQ(profile.noise.readNoiseElectrons, 3);
    EXPECT_EQ(profile.response.coefficients, sensor.linearity.linearity.coefficients);
    EXPECT_DOUBLE_EQ(profile.linearity, 1e-4);
    EXPECT_EQ(profile.hash, "0badcafe/14");
}

TEST(RigRecords, DarkFramesComeBack) {
    std::vector<proc::DarkFrame> darks;
    for (const int us : {80, 5120}) {
        darks.push_back(
            {.mean = Image<float>(kSize, 60.5F),
             .varianceOfMean = 0.01,
             .hot = {{.x = 3, .y = 4, .excessDn = 17}},
             .exposure = {.requested = Microseconds(us), .granted = Nanoseconds(us * 1000 + 14)},
             .window = {.x = 4, .y = 8, .size = kSize},
             .gainDb = 0,
             .frames = 32});
    }
    const auto back = decodeDarks(*encodeDarks(darks), "dark");
    ASSERT_TRUE(back) << back.error().message;
    ASSERT_EQ(back->size(), 2U);
    EXPECT_EQ((*back)[1].exposure.granted, darks[1].exposure.granted);
    EXPECT_EQ((*back)[1].mean, darks[1].mean);
    EXPECT_EQ((*back)[1].window, darks[1].window);
    ASSERT_EQ((*back)[0].hot.size(), 1U);
    EXPECT_EQ((*back)[0].hot[0].excessDn, 17);
    darks[0].hot[0].x = 40;
    EXPECT_EQ(decodeDarks(*encodeDarks(darks), "dark").error().kind, ErrorKind::File);
    darks[0].hot.clear();
    darks[1].window.x = 8;
    EXPECT_FALSE(decodeDarks(*encodeDarks(darks), "dark")) << "of another window";
    darks[1].window.x = 4;
    darks[1].mean.at(1, 1) = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(decodeDarks(*encodeDarks(darks), "dark")) << "not finite";
}

TEST(RigRecords, HostileNumbersAreFileErrors) {
    proc::FlatField flat{.response = Image<float>(kSize, 1.0F), .window = {.size = kSize}};
    flat.window.binning = 0;
    EXPECT_EQ(decodeFlat(*encodeFlat(flat), "x").error().kind, ErrorKind::File);
    proc::LedMonitor leds;
    leds.bands[0].perKelvin = -1;
    EXPECT_EQ(decodeLeds(encodeLeds(leds), "x").error().kind, ErrorKind::File);
}

TEST(RigRecords, WhatIsNoneIsAFileError) {
    for (const std::string text : {"", "{}", "[1]", "\xff", R"({"schema":"gonio/leds/2"})"}) {
        EXPECT_EQ(decodeLeds(text, "x").error().kind, ErrorKind::File) << text;
        EXPECT_EQ(decodeSensor(text, "x").error().kind, ErrorKind::File) << text;
        EXPECT_EQ(decodeFlat(text, "x").error().kind, ErrorKind::File) << text;
        EXPECT_EQ(decodeDarks(text, "x").error().kind, ErrorKind::File) << text;
    }
}

}  // namespace
}  // namespace gonio::daemon
