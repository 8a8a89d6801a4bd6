#include "proc/core/image.h"

#include <gtest/gtest.h>

#include <numeric>

namespace gonio {
namespace {

TEST(Size, CountsPixelsBeyondThirtyTwoBits) {
    EXPECT_EQ((Size{3, 2}.pixels()), 6U);
    EXPECT_EQ((Size{}.pixels()), 0U);
    EXPECT_EQ((Size{1 << 20, 1 << 20}.pixels()), std::size_t{1} << 40);
}

TEST(Image, IsFilledWithWhatItIsGiven) {
    const Image<int> image({4, 3}, 7);
    EXPECT_EQ(image.width(), 4);
    EXPECT_EQ(image.height(), 3);
    ASSERT_EQ(image.pixels().size(), 12U);
    for (int pixel : image.pixels()) EXPECT_EQ(pixel, 7);
    EXPECT_EQ(Image<int>({4, 3}).at(3, 2), 0);
}

TEST(Image, RowsAreItsPixelsInOrder) {
    std::vector<int> numbers(12);
    std::iota(numbers.begin(), numbers.end(), 0);
    Image<int> image({4, 3}, numbers);
    int wanted = 0;
    for (int y = 0; y < 3; ++y) {
        ASSERT_EQ(image.row(y).size(), 4U);
        for (int x = 0; x < 4; ++x, ++wanted) {
            EXPECT_EQ(image.at(x, y), wanted);
            EXPECT_EQ(std::as_const(image).row(y)[static_cast<std::size_t>(x)], wanted);
        }
    }
    image.row(2)[3] = -1;
    EXPECT_EQ(image.pixels().back(), -1);
}

TEST(Image, EqualsOnlyWhatHasItsShapeAndPixels) {
    const Image<int> image({4, 3}, 1);
    EXPECT_EQ(image, Image<int>({4, 3}, 1));
    EXPECT_NE(image, Image<int>({3, 4}, 1));
    Image<int> other = image;
    other.at(3, 2) = 2;
    EXPECT_NE(image, other);
    EXPECT_TRUE(Image<int>({0, 5}).empty());
    EXPECT_FALSE(image.empty());
}

}  // namespace
}  // namespace gonio
