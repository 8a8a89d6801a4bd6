#include "proc/formats/utia.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "proc/formats/exr_parts.h"
#include "proc/formats/little_endian.h"
#include "tests/formats/refusal.h"

namespace gonio::proc {
namespace {

using test::refuses;

constexpr std::size_t kPlane = 288 * 288;

/// Value i of the file is i.
std::string countingFile() {
    std::string bytes;
    for (std::size_t i = 0; i < 3 * kPlane; ++i) appendLittle(bytes, static_cast<double>(i));
    return bytes;
}

std::string with(std::string bytes, std::size_t value, double number) {
    std::string raw;
    appendLittle(raw, number);
    return bytes.replace(8 * value, 8, raw);
}

/// The number in the file of a pair of directions, in degrees.
double numberAt(std::size_t plane, double ti, double pi, double tv, double pv) {
    return static_cast<double>(plane * kPlane) + 288 * (48 * ti / 15 + pi / 7.5) + 48 * tv / 15 +
           pv / 7.5;
}

TEST(Utia, ReadsEveryNumberAtItsDirections) {
    const auto read = parseUtia(countingFile(), "t.bin");
    ASSERT_TRUE(read) << read.error().message;
    const SphericalTable& table = read->content;
    ASSERT_EQ(table.blocks.size(), 3U * 288);
    EXPECT_FALSE(table.isotropic());
    for (const SphericalBlock& block : table.blocks) {
        for (std::size_t a = 0; a < 48; a += 5) {
            for (std::size_t t = 1; t < 6; ++t) {
                const LightView pair = table.pairAt(block, a, t);
                const double phiOut = std::round(pair.out.phi().degrees() * 10) / 10;
                ASSERT_EQ(block.f[block.index(a, t)],
                          numberAt(block.channel,
                                   block.incidenceDeg,
                                   block.lightAzimuthDeg,
                                   block.thetaDeg[t],
                                   phiOut == 360 ? 0 : phiOut));
            }
        }
    }
    ASSERT_EQ(read->warnings.size(), 1U);
    EXPECT_NE(read->warnings[0].find("disputed"), std::string::npos);
}

TEST(Utia, WritesTheSameBytesAgain) {
    const std::string bytes = with(countingFile(), 17, -2.5);
    const auto read = parseUtia(bytes, "t.bin");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->warnings.at(1), "1 negative values");
    const auto written = writeUtia(read->content);
    ASSERT_TRUE(written) << written.error().message;
    EXPECT_EQ(written->bytes, bytes);
    EXPECT_TRUE(written->loss.items.empty());
}

TEST(Utia, DecodesTheOtherScaleWhereItIsAsked) {
    const std::string bytes = with(with(countingFile(), 0, 140 * 0.5), 1, 140 * 0.03);
    const auto read = parseUtia(bytes, "t.bin", UtiaScale::DjBrdf);
    ASSERT_TRUE(read);
    const SphericalBlock& first = read->content.blocks[0];
    EXPECT_NEAR(first.f[first.index(0, 0)], 100 * std::pow(0.555 / 1.055, 2.4), 1e-12);
    EXPECT_NEAR(first.f[first.index(1, 0)], 100 * 0.03 / 12.92, 1e-12);
    EXPECT_TRUE(read->warnings.empty());
}

TEST(Utia, ReadsThePictureAsTheFile) {
    ExrPart picture;
    picture.size = {288, 288};
    for (const char* name : {"R", "G", "B"}) {
        auto& plane = picture.floats[name];
        for (std::size_t i = 0; i < kPlane; ++i) {
            plane.push_back(static_cast<float>(i) + static_cast<float>(name[0]));
        }
    }
    const auto bytes = encodeExr(std::vector{picture});
    ASSERT_TRUE(bytes);
    const auto read = parseUtiaExr(*bytes, "t.exr");
    ASSERT_TRUE(read) << read.error().message;
    std::string raw;
    for (const char* name : {"R", "G", "B"}) {
        for (const float number : picture.floats[name]) {
            appendLittle(raw, static_cast<double>(number));
        }
    }
    const auto same = parseUtia(raw, "t.bin");
    ASSERT_TRUE(same);
    for (std::size_t i = 0; i < 3 * 288; ++i) {
        ASSERT_EQ(read->content.blocks[i].f, same->content.blocks[i].f);
    }
    picture.size = {144, 576};
    EXPECT_TRUE(refuses(parseUtiaExr(*encodeExr(std::vector{picture}), "t.exr")));
    picture.size = {288, 288};
    picture.floats.erase("G");
    EXPECT_TRUE(refuses(parseUtiaExr(*encodeExr(std::vector{picture}), "t.exr"), {"R, G and B"}));
    EXPECT_TRUE(refuses(parseUtiaExr("", "t.exr"), {"utia: t.exr"}));
}

TEST(Utia, RefusesAnotherLengthAndNumbersThatAreNone) {
    const std::string bytes = countingFile();
    EXPECT_TRUE(refuses(parseUtia("", "t.bin"), {"utia: t.bin: 0 bytes, wanted 1990656"}));
    EXPECT_TRUE(refuses(parseUtia(bytes.substr(1), "t.bin"), {"1990655 bytes"}));
    EXPECT_TRUE(refuses(parseUtia(bytes + "x", "t.bin"), {"1990657 bytes"}));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(refuses(parseUtia(with(bytes, 1000, nan), "t.bin"), {"value 1000"}));
}

TEST(Utia, WritesMissingValuesAsZeroAndSaysSo) {
    SphericalTable table = utiaGrid();
    const auto written = writeUtia(table);
    ASSERT_TRUE(written);
    ASSERT_EQ(written->loss.items.size(), 1U);
    EXPECT_EQ(written->loss.items[0].kind, Loss::Clamped);
    EXPECT_EQ(written->loss.items[0].count, 3 * kPlane);
    table.blocks[5].thetaDeg[1] = 16;
    EXPECT_FALSE(writeUtia(table));
    EXPECT_FALSE(writeUtia(SphericalTable{}));
}

}  // namespace
}  // namespace gonio::proc
