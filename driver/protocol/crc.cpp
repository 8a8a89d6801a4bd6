#include "driver/protocol/crc.h"

#include <array>
#include <cstddef>
#include <cstring>

#if defined(__x86_64__)
#include <nmmintrin.h>
#endif

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

std::uint32_t addByTable(std::uint32_t crc, std::span<const std::uint8_t> bytes) {
    std::size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) {
        const auto at = [&](std::size_t k) { return std::uint32_t{bytes[i + k]}; };
        crc ^= at(0) | at(1) << 8 | at(2) << 16 | at(3) << 24;
        crc = kTable32[7][crc & 0xFFU] ^ kTable32[6][(crc >> 8) & 0xFFU] ^
              kTable32[5][(crc >> 16) & 0xFFU] ^ kTable32[4][crc >> 24] ^ kTable32[3][at(4)] ^
              kTable32[2][at(5)] ^ kTable32[1][at(6)] ^ kTable32[0][at(7)];
    }
    for (; i < bytes.size(); ++i) crc = (crc >> 8) ^ kTable32[0][(crc ^ bytes[i]) & 0xFFU];
    return crc;
}

#if defined(__x86_64__)

// The instruction takes a new eight bytes each cycle, but answers after three: three runs of bytes
// are summed at once, and put together by moving a sum over as many zero bytes as come after it.
constexpr std::size_t kRun = 1024;
using Shift = std::array<std::array<std::uint32_t, 256>, 4>;

/// What each byte of a sum becomes when `zeros` zero bytes follow.
constexpr Shift makeShift(std::size_t zeros) {
    std::array<std::uint32_t, 32> bits{};
    for (std::size_t bit = 0; bit < 32; ++bit) {
        std::uint32_t crc = std::uint32_t{1} << bit;
        for (std::size_t i = 0; i < zeros; ++i) crc = (crc >> 8) ^ kTable32[0][crc & 0xFFU];
        bits[bit] = crc;
    }
    Shift shift{};
    for (std::size_t place = 0; place < 4; ++place) {
        for (std::size_t byte = 0; byte < 256; ++byte) {
            for (std::size_t bit = 0; bit < 8; ++bit)
                if ((byte >> bit & 1U) != 0) shift[place][byte] ^= bits[8 * place + bit];
        }
    }
    return shift;
}

constexpr Shift kOverOne = makeShift(kRun), kOverTwo = makeShift(2 * kRun);

std::uint32_t moved(std::uint64_t crc, const Shift& shift) {
    return shift[0][crc & 0xFFU] ^ shift[1][crc >> 8 & 0xFFU] ^ shift[2][crc >> 16 & 0xFFU] ^
           shift[3][crc >> 24 & 0xFFU];
}

std::uint64_t eightBytes(const std::uint8_t* at) {
    std::uint64_t word = 0;
    std::memcpy(&word, at, sizeof word);
    return word;
}

[[gnu::target("sse4.2")]] std::uint32_t addByInstruction(std::uint32_t crc,
                                                         std::span<const std::uint8_t> bytes) {
    const std::uint8_t* at = bytes.data();
    std::size_t left = bytes.size();
    std::uint64_t first = crc;
    for (; left >= 3 * kRun; left -= 3 * kRun, at += 2 * kRun) {
        std::uint64_t second = 0, third = 0;
        for (const std::uint8_t* end = at + kRun; at != end; at += 8) {
            first = _mm_crc32_u64(first, eightBytes(at));
            second = _mm_crc32_u64(second, eightBytes(at + kRun));
            third = _mm_crc32_u64(third, eightBytes(at + 2 * kRun));
        }
        first = moved(first, kOverTwo) ^ moved(second, kOverOne) ^ third;
    }
    for (; left >= 8; left -= 8, at += 8) first = _mm_crc32_u64(first, eightBytes(at));
    auto sum = static_cast<std::uint32_t>(first);
    for (; left > 0; --left) sum = _mm_crc32_u8(sum, *at++);
    return sum;
}

const bool kHasInstruction = __builtin_cpu_supports("sse4.2") != 0;

std::uint32_t add(std::uint32_t crc, std::span<const std::uint8_t> bytes) {
    return kHasInstruction ? addByInstruction(crc, bytes) : addByTable(crc, bytes);
}

#else

std::uint32_t add(std::uint32_t crc, std::span<const std::uint8_t> bytes) {
    return addByTable(crc, bytes);
}

#endif

}  // namespace

std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
    unsigned crc = 0xFFFF;
    for (std::uint8_t byte : bytes)
        crc = ((crc << 8) ^ kTable16[((crc >> 8) ^ byte) & 0xFFU]) & 0xFFFFU;
    return static_cast<std::uint16_t>(crc);
}

void Crc32c::add(std::span<const std::uint8_t> bytes) { state_ = driver::add(state_, bytes); }

std::uint32_t crc32c(std::span<const std::uint8_t> bytes) {
    Crc32c crc;
    crc.add(bytes);
    return crc.value();
}

std::uint32_t crc32cByTable(std::span<const std::uint8_t> bytes) {
    return ~addByTable(0xFFFFFFFFU, bytes);
}

}  // namespace gonio::driver
