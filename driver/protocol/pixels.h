#pragma once
// Pixels on the wire, rows from the top without padding. Mono 12 packed: pixels p, q are the bytes
// p[7:0], q[3:0] << 4 | p[11:8], q[11:4]; the last pixel of an odd row takes two bytes. Mono 16:
// little endian.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "driver/protocol/constants.h"
#include "proc/core/image.h"

namespace gonio::driver {

/// Bytes of a row; empty for an unknown format.
[[nodiscard]] std::optional<std::uint32_t> strideOf(PixelFormat format, int width);

[[nodiscard]] std::vector<std::uint8_t> packPixels(const Image<std::uint16_t>& image,
                                                   PixelFormat format);
/// Precondition: `bytes` holds stride x height bytes of a known format.
[[nodiscard]] Image<std::uint16_t> unpackPixels(std::span<const std::uint8_t> bytes,
                                                Size size,
                                                PixelFormat format);
/// The same, into the memory of a picture of that size.
void unpackInto(Image<std::uint16_t>& image,
                std::span<const std::uint8_t> bytes,
                PixelFormat format);

}  // namespace gonio::driver
