#include "proc/formats/merl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "proc/formats/little_endian.h"
#include "tests/formats/refusal.h"

namespace gonio::proc {
namespace {

using test::refuses;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

std::string header(std::int32_t h, std::int32_t d, std::int32_t p) {
    std::string bytes;
    for (const std::int32_t count : {h, d, p}) appendLittle(bytes, count);
    return bytes;
}

/// 2 x 3 x 4 values: 1500, 1501, ...
std::string smallFile() {
    std::string bytes = header(2, 3, 4);
    for (int i = 0; i < 72; ++i) appendLittle(bytes, 1500.0 + i);
    return bytes;
}

std::string with(std::string bytes, std::size_t value, double number) {
    std::string raw;
    appendLittle(raw, number);
    return bytes.replace(12 + 8 * value, 8, raw);
}

HalfDifferenceTable parsed(std::string_view bytes) {
    auto read = parseMerl(bytes, "t.binary");
    EXPECT_TRUE(read) << (read ? "" : read.error().message);
    return read ? std::move(read->content) : HalfDifferenceTable{};
}

TEST(Merl, ReadsPlanesInTheirOrderAndScale) {
    const HalfDifferenceTable table = parsed(smallFile());
    EXPECT_EQ(table.thetaHalfCount, 2U);
    EXPECT_EQ(table.thetaDiffCount, 3U);
    EXPECT_EQ(table.phiDiffCount, 4U);
    EXPECT_FALSE(table.wholeCircle);
    EXPECT_DOUBLE_EQ(table.planes[0][0], 1);
    EXPECT_DOUBLE_EQ(table.planes[1][0], 1.15 * 1524 / 1500);
    EXPECT_DOUBLE_EQ(table.planes[2][table.index({1, 2, 3})], 1.66 * 1571 / 1500);
}

TEST(Merl, TakesANegativeValueForNone) {
    auto read = parseMerl(with(smallFile(), 5, -0.25), "t.binary");
    ASSERT_TRUE(read);
    EXPECT_TRUE(std::isnan(read->content.planes[0][5]));
    EXPECT_FALSE(std::isnan(read->content.planes[0][4]));
    EXPECT_EQ(read->warnings, std::vector<std::string>{"1 negative values: no data there"});
}

TEST(Merl, TakesAThirdCountOf360ForTheWholeCircle) {
    std::string bytes = header(1, 1, 360);
    for (int i = 0; i < 1080; ++i) appendLittle(bytes, 1.0);
    EXPECT_TRUE(parsed(bytes).wholeCircle);
}

TEST(Merl, WritesTheSameBytesAgain) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> exponent(-30, 30);
    HalfDifferenceTable table;
    table.thetaHalfCount = 20;
    table.thetaDiffCount = 20;
    table.phiDiffCount = 50;
    for (auto& plane : table.planes) {
        for (std::size_t i = 0; i < table.nodeCount(); ++i) {
            plane.push_back(i % 17 == 0 ? kNan : std::exp(exponent(random)));
        }
    }
    const Written once = writeMerl(table);
    const HalfDifferenceTable back = parsed(once.bytes);
    for (std::size_t band = 0; band < 3; ++band) {
        for (std::size_t i = 0; i < table.nodeCount(); ++i) {
            const double f = table.planes[band][i];
            if (std::isnan(f)) {
                ASSERT_TRUE(std::isnan(back.planes[band][i]));
            } else {
                ASSERT_NEAR(back.planes[band][i], f, 3e-16 * f);
            }
        }
    }
    EXPECT_EQ(writeMerl(back).bytes, once.bytes);
}

TEST(Merl, ReportsWhatItLeavesOut) {
    HalfDifferenceTable table = parsed(smallFile());
    table.planes[0][0] = kNan;
    table.planes[1][0] = -0.5;
    table.planes[2][0] = kInf;
    Metadata about;
    about.set("sample", "tile");
    about.comments = {"a comment"};
    const Written out = writeMerl(table, about);
    std::size_t masked = 0;
    std::size_t dropped = 0;
    for (const LossReport::Item& item : out.loss.items) {
        (item.kind == Loss::Masked ? masked : dropped) += item.count;
    }
    EXPECT_EQ(masked, 3U);
    EXPECT_EQ(dropped, 2U);
    EXPECT_EQ(littleAt<double>(out.bytes, 12), -1);
    EXPECT_TRUE(writeMerl(parsed(smallFile())).loss.items.empty());
}

TEST(Merl, DoesNotCountNodesBelowTheHorizonAsLost) {
    HalfDifferenceTable table;
    table.phiDiffCount = 20;
    for (auto& plane : table.planes) {
        for (std::size_t i = 0; i < table.nodeCount(); ++i) {
            plane.push_back(aboveHorizon(table.pairAt(table.nodeAt(i))) ? 0.25 : kNan);
        }
    }
    EXPECT_GT(
        std::count_if(
            table.planes[0].begin(), table.planes[0].end(), [](double f) { return std::isnan(f); }),
        0);
    EXPECT_TRUE(writeMerl(table).loss.items.empty());
}

TEST(Merl, RefusesWhatIsNoSuchFile) {
    const std::string sound = smallFile();
    EXPECT_TRUE(refuses(parseMerl("", "t.binary"), {"merl: t.binary: 0 bytes"}));
    EXPECT_TRUE(refuses(parseMerl(sound.substr(0, 11), "t.binary"), {"11 bytes"}));
    EXPECT_TRUE(
        refuses(parseMerl(sound.substr(0, 500), "t.binary"), {"500 bytes", "2 x 3 x 4 want 588"}));
    EXPECT_TRUE(refuses(parseMerl(sound + "x", "t.binary"), {"589 bytes"}));
    EXPECT_TRUE(refuses(parseMerl(header(0, 3, 4), "t.binary"), {"0 x 3 x 4"}));
    EXPECT_TRUE(refuses(parseMerl(header(-2, 3, 4), "t.binary"), {"-2 x 3 x 4"}));
    constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
    EXPECT_TRUE(refuses(parseMerl(header(kMost, kMost, kMost), "t.binary"), {"2147483647"}));
    EXPECT_TRUE(refuses(parseMerl(header(kMost, kMost, 1), "t.binary")));
    EXPECT_TRUE(refuses(parseMerl("\xEF\xBB\xBFSymmetry Plane", "t.binary")));
}

TEST(Merl, RefusesANumberThatIsNone) {
    EXPECT_TRUE(refuses(parseMerl(with(smallFile(), 30, kNan), "t.binary"),
                        {"plane G, value 6 is not a finite number"}));
    EXPECT_TRUE(
        refuses(parseMerl(with(smallFile(), 71, -kInf), "t.binary"), {"plane B, value 23"}));
}

TEST(Merl, RefusesEveryTruncation) {
    const std::string sound = smallFile();
    for (std::size_t size = 0; size < sound.size(); ++size) {
        EXPECT_FALSE(parseMerl(std::string_view(sound).substr(0, size), "t.binary"));
    }
}

}  // namespace
}  // namespace gonio::proc
