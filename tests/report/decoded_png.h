#pragma once
// A PNG as its pixels' colours.

#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::test {

struct Decoded {
    int width = 0, height = 0;
    std::vector<std::string> colours;  ///< "#rrggbb", row by row; "" where nothing covers
};

inline Decoded decodedPng(std::string_view bytes) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0)
        << image.message;
    image.format = PNG_FORMAT_RGBA;
    std::vector<png_byte> pixels(PNG_IMAGE_SIZE(image));
    EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0)
        << image.message;
    Decoded decoded{static_cast<int>(image.width), static_cast<int>(image.height), {}};
    for (std::size_t at = 0; at + 3 < pixels.size(); at += 4) {
        std::array<char, 8> text{};
        std::snprintf(
            text.data(), text.size(), "#%02x%02x%02x", pixels[at], pixels[at + 1], pixels[at + 2]);
        decoded.colours.emplace_back(pixels[at + 3] == 0 ? "" : text.data());
    }
    return decoded;
}

inline std::string fromBase64(std::string_view text) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned group = 0, bits = 0;
    for (const char c : text.substr(0, text.find('='))) {
        const std::size_t digit = kDigits.find(c);
        EXPECT_NE(digit, std::string_view::npos) << c;
        group = group << 6U | static_cast<unsigned>(digit);
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes += static_cast<char>(group >> bits & 255U);
    }
    return bytes;
}

inline Decoded decodedUri(const std::string& uri) {
    const std::string head = "data:image/png;base64,";
    EXPECT_EQ(uri.substr(0, head.size()), head);
    return decodedPng(fromBase64(std::string_view(uri).substr(head.size())));
}

}  // namespace gonio::test
