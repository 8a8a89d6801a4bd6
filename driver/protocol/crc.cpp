#include "driver/protocol/crc.h"

#include <array>
#include <cstddef>

namespace gonio::driver {
namespace {

using Table16 = std::array<std::uint16_t, 256>;
using Table32 = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr Table16 makeTable16() {
    Table16 table{};
    for (unsigned byte = 0; byte < 256; ++byte) {
        unsigned crc = byte << 8;
        for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U);
        table[byte] = static_cast<std::uint16_t>(crc);
    }
    return table;
}

// Row k advances a byte by k further bytes, so that eight bytes are folded in one step.
constexpr Table32 makeTable32() {
    Table32 table{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t crc = byte;
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0x82F63B78U : 0U);
        table[0][byte] = crc;
    }
    for (std::size_t k = 1; k < 8; ++k) {
        for (std::size_t byte = 0; byte < 256; ++byte) {
            const std::uint32_t before = table[k - 1][byte];
            table[k][byte] = (before >> 8) ^ table[0][before & 0xFFU];
        }
    }
    return table;
}

constexpr Table16 kTable16 = makeTable16();
constexpr Table32 kTable32 = makeTable32();

}  // namespace

std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
    unsigned crc = 0xFFFF;
    for (std::uint8_t byte : bytes)
        crc = ((crc << 8) ^ kTable16[((crc >> 8) ^ byte) & 0xFFU]) & 0xFFFFU;
    return static_cast<std::uint16_t>(crc);
}

void Crc32c::add(std::span<const std::uint8_t> bytes) {
    std::uint32_t crc = state_;
    std::size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) {
        const auto at = [&](std::size_t k) { return std::uint32_t{bytes[i + k]}; };
        crc ^= at(0) | at(1) << 8 | at(2) << 16 | at(3) << 24;
        crc = kTable32[7][crc & 0xFFU] ^ kTable32[6][(crc >> 8) & 0xFFU] ^
              kTable32[5][(crc >> 16) & 0xFFU] ^ kTable32[4][crc >> 24] ^ kTable32[3][at(4)] ^
              kTable32[2][at(5)] ^ kTable32[1][at(6)] ^ kTable32[0][at(7)];
    }
    for (; i < bytes.size(); ++i) crc = (crc >> 8) ^ kTable32[0][(crc ^ bytes[i]) & 0xFFU];
    state_ = crc;
}

std::uint32_t crc32c(std::span<const std::uint8_t> bytes) {
    Crc32c crc;
    crc.add(bytes);
    return crc.value();
}

}  // namespace gonio::driver
