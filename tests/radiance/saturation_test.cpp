#include "proc/radiance/saturation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace gonio::proc {
namespace {

using Picture = Image<std::uint16_t>;

bool usableAt(const Picture& picture, int x, int y) {
    std::vector<std::uint8_t> row(static_cast<std::size_t>(picture.width()));
    markUsable(picture, y, {}, row);
    return row[static_cast<std::size_t>(x)] == 1;
}

TEST(Saturation, NeighboursDecideAtNinetyFivePerCent) {
    // 0.95 x 4095 = 3890.25.
    EXPECT_TRUE(usableAt(Picture({5, 5}, 3890), 2, 2));
    EXPECT_FALSE(usableAt(Picture({5, 5}, 3891), 2, 2));
    Picture one({5, 5}, 3890);
    one.at(2, 2) = 4033;  // below 0.985 x 4095 = 4033.575
    EXPECT_TRUE(usableAt(one, 2, 2));
    one.at(2, 2) = 4034;
    EXPECT_FALSE(usableAt(one, 2, 2));
    one.at(2, 2) = 60;
    one.at(1, 2) = one.at(3, 2) = one.at(2, 1) = one.at(2, 3) = 3891;
    EXPECT_FALSE(usableAt(one, 2, 2));  // low by its own noise alone
}

TEST(Saturation, AHotPixelsExcessIsAddedToItsNeighbours) {
    Picture picture({5, 5}, 1000);
    picture.at(2, 2) = 3890;
    EXPECT_TRUE(usableReference(picture, 2, 2, {}, 2890));  // 3890 < 3890.25
    EXPECT_FALSE(usableReference(picture, 2, 2, {}, 2890.5));
    EXPECT_TRUE(usableReference(picture, 2, 2, {}, 0));
    picture.at(2, 2) = 60;  // low by its own noise alone
    EXPECT_FALSE(usableReference(picture, 2, 2, {}, 2890.5));
}

TEST(Saturation, EdgesHaveNeighboursInsideOnly) {
    Picture picture({3, 3}, 100);
    picture.at(1, 0) = 4095;
    picture.at(0, 1) = 4095;
    EXPECT_FALSE(usableAt(picture, 0, 0));  // both inner neighbours, twice each
    EXPECT_TRUE(usableAt(picture, 2, 2));
    EXPECT_TRUE(usableAt(Picture({1, 1}, 3890), 0, 0));
    EXPECT_FALSE(usableAt(Picture({1, 1}, 3891), 0, 0));
}

TEST(Saturation, MatchesReference) {
    std::mt19937 random(5);
    std::uniform_int_distribution<int> level(3600, 4095);
    for (const Size size : {Size{1, 1}, Size{2, 1}, Size{1, 2}, Size{2, 2}, Size{37, 23}}) {
        Picture picture(size);
        for (std::uint16_t& dn : picture.pixels()) dn = static_cast<std::uint16_t>(level(random));
        for (int y = 0; y < size.height; ++y) {
            for (int x = 0; x < size.width; ++x) {
                EXPECT_EQ(usableAt(picture, x, y), usableReference(picture, x, y, {}))
                    << x << ' ' << y;
            }
        }
    }
}

TEST(Saturation, VerdictIsIndependentOfTheSamplesOwnNoise) {
    // A flat field at the border: what is kept has the mean of all, to 4 standard errors.
    std::mt19937_64 random(17);
    std::normal_distribution<double> noise(3890.25, 39);
    Picture picture({256, 256});
    for (std::uint16_t& dn : picture.pixels()) {
        dn = static_cast<std::uint16_t>(std::lround(noise(random)));
    }
    double sum = 0;
    int kept = 0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            if (!usableAt(picture, x, y)) continue;
            sum += picture.at(x, y);
            ++kept;
        }
    }
    EXPECT_GT(kept, 256 * 256 / 3);
    EXPECT_NEAR(sum / kept, 3890.25, 4 * 39 / std::sqrt(kept));
}

}  // namespace
}  // namespace gonio::proc
