#pragma once
// The two checksums of GRP/1. CRC-16/CCITT-FALSE guards reports (check value 0x29B1), CRC-32C
// (Castagnoli) chunk headers, payloads and frames (check value 0xE3069283), both of "123456789".
// CRC-32C is summed by the processor's instruction where there is one (x86-64 with SSE 4.2).

#include <cstdint>
#include <span>

namespace gonio::driver {

[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> bytes);

/// CRC-32C of bytes fed in pieces: value() is that of all bytes so far.
class Crc32c {
public:
    void add(std::span<const std::uint8_t> bytes);
    [[nodiscard]] std::uint32_t value() const { return ~state_; }

private:
    std::uint32_t state_ = 0xFFFFFFFFU;
};

[[nodiscard]] std::uint32_t crc32c(std::span<const std::uint8_t> bytes);
/// The same without the instruction.
[[nodiscard]] std::uint32_t crc32cByTable(std::span<const std::uint8_t> bytes);

}  // namespace gonio::driver
