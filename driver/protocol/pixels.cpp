#include "driver/protocol/pixels.h"

#include <bit>
#include <cassert>
#include <cstring>

namespace gonio::driver {
namespace {

std::uint8_t low(unsigned v) { return static_cast<std::uint8_t>(v & 0xFFU); }

void packRow12(std::span<const std::uint16_t> row, std::uint8_t* out) {
    std::size_t x = 0;
    for (; x + 1 < row.size(); x += 2, out += 3) {
        const unsigned p = row[x];
        const unsigned q = row[x + 1];
        out[0] = low(p);
        out[1] = low((q & 0xFU) << 4 | (p >> 8 & 0xFU));
        out[2] = low(q >> 4);
    }
    if (x < row.size()) {
        out[0] = low(row[x]);
        out[1] = low(row[x] >> 8 & 0xFU);
    }
}

/// Four pixels of 12 bits, the first lowest, as four of 16.
std::uint64_t spread12(std::uint64_t packed) {
    return (packed & 0xFFFU) | (packed & 0xFFF000U) << 4 | (packed & 0xFFF000000U) << 8 |
           (packed & 0xFFF000000000U) << 12;
}

void unpackRow12(const std::uint8_t* in, std::span<std::uint16_t> row) {
    std::size_t x = 0;
    if constexpr (std::endian::native == std::endian::little) {
        constexpr std::size_t kRead = 6;  // pixels that eight bytes reach into
        for (; x + kRead <= row.size(); x += 4, in += 6) {
            std::uint64_t packed = 0;
            std::memcpy(&packed, in, sizeof packed);
            const std::uint64_t four = spread12(packed);
            std::memcpy(&row[x], &four, sizeof four);
        }
    }
    for (; x + 1 < row.size(); x += 2, in += 3) {
        row[x] = static_cast<std::uint16_t>(in[0] | (in[1] & 0xFU) << 8);
        row[x + 1] = static_cast<std::uint16_t>(in[1] >> 4 | in[2] << 4);
    }
    if (x < row.size()) row[x] = static_cast<std::uint16_t>(in[0] | (in[1] & 0xFU) << 8);
}

void packRow16(std::span<const std::uint16_t> row, std::uint8_t* out) {
    for (std::uint16_t pixel : row) {
        *out++ = low(pixel);
        *out++ = low(pixel >> 8);
    }
}

void unpackRow16(const std::uint8_t* in, std::span<std::uint16_t> row) {
    for (std::uint16_t& pixel : row) {
        pixel = static_cast<std::uint16_t>(in[0] | in[1] << 8);
        in += 2;
    }
}

}  // namespace

std::optional<std::uint32_t> strideOf(PixelFormat format, int width) {
    const auto w = static_cast<std::uint32_t>(width);
    switch (format) {
        case PixelFormat::Mono12Packed: return (3 * w + 1) / 2;
        case PixelFormat::Mono16: return 2 * w;
    }
    return std::nullopt;
}

std::vector<std::uint8_t> packPixels(const Image<std::uint16_t>& image, PixelFormat format) {
    const std::size_t stride = strideOf(format, image.width()).value_or(0);
    std::vector<std::uint8_t> bytes(stride * static_cast<std::size_t>(image.height()));
    for (int y = 0; y < image.height(); ++y) {
        std::uint8_t* out = bytes.data() + stride * static_cast<std::size_t>(y);
        if (format == PixelFormat::Mono12Packed) {
            packRow12(image.row(y), out);
        } else {
            packRow16(image.row(y), out);
        }
    }
    return bytes;
}

Image<std::uint16_t> unpackPixels(std::span<const std::uint8_t> bytes,
                                  Size size,
                                  PixelFormat format) {
    Image<std::uint16_t> image(size);
    unpackInto(image, bytes, format);
    return image;
}

void unpackInto(Image<std::uint16_t>& image,
                std::span<const std::uint8_t> bytes,
                PixelFormat format) {
    const std::size_t stride = strideOf(format, image.width()).value_or(0);
    assert(bytes.size() == stride * static_cast<std::size_t>(image.height()));
    for (int y = 0; y < image.height(); ++y) {
        const std::uint8_t* in = bytes.data() + stride * static_cast<std::size_t>(y);
        if (format == PixelFormat::Mono12Packed) {
            unpackRow12(in, image.row(y));
        } else {
            unpackRow16(in, image.row(y));
        }
    }
}

}  // namespace gonio::driver
