#include "driver/protocol/pixels.h"

#include <gtest/gtest.h>

#include <random>

#include "driver/protocol/crc.h"
#include "tests/support/hex.h"

namespace gonio::driver {
namespace {

TEST(Golden, PackedPixels) {
    const Image<std::uint16_t> image({3, 2}, {0xABC, 0x123, 0xDEF, 0x001, 0x002, 0x003});
    const auto bytes = packPixels(image, PixelFormat::Mono12Packed);
    EXPECT_EQ(bytes, test::hex("BC 3A 12 EF 0D 01 20 00 03 00"));
    EXPECT_EQ(crc32c(bytes), 0xB4ED3658U);
    EXPECT_EQ(unpackPixels(bytes, {3, 2}, PixelFormat::Mono12Packed), image);
}

TEST(Pixels, RoundTripAtEveryWidth) {
    std::mt19937 random(5);
    for (int width = 1; width < 20; ++width) {
        for (PixelFormat format : {PixelFormat::Mono12Packed, PixelFormat::Mono16}) {
            Image<std::uint16_t> image({width, 3});
            const unsigned mask = format == PixelFormat::Mono12Packed ? 0xFFFU : 0xFFFFU;
            for (auto& pixel : image.pixels()) pixel = static_cast<std::uint16_t>(random() & mask);
            const auto bytes = packPixels(image, format);
            EXPECT_EQ(bytes.size(), *strideOf(format, width) * 3);
            EXPECT_EQ(unpackPixels(bytes, {width, 3}, format), image);
        }
    }
}

TEST(Pixels, UnknownFormatHasNoStride) { EXPECT_FALSE(strideOf(static_cast<PixelFormat>(9), 4)); }

TEST(Pixels, StrideIsThatOfWholeRows) {
    for (int width = 1; width <= 20; ++width) {
        const auto pixels = static_cast<std::uint32_t>(width);
        EXPECT_EQ(strideOf(PixelFormat::Mono16, width), 2 * pixels);
        EXPECT_EQ(strideOf(PixelFormat::Mono12Packed, width), (3 * pixels + 1) / 2);
    }
    EXPECT_FALSE(strideOf(static_cast<PixelFormat>(0), 4));
}

}  // namespace
}  // namespace gonio::driver
