#include "driver/protocol/crc.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace gonio::driver {
namespace {

std::vector<std::uint8_t> digits() {
    const std::string text = "123456789";
    return {text.begin(), text.end()};
}

/// The definition, bit by bit: the slow twin of the tables.
std::uint32_t crc32cBitwise(const std::vector<std::uint8_t>& bytes) {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0x82F63B78U : 0U);
    }
    return ~crc;
}

TEST(Crc, HasTheCheckValues) {
    EXPECT_EQ(crc16(digits()), 0x29B1);
    EXPECT_EQ(crc32c(digits()), 0xE3069283U);
    EXPECT_EQ(crc16({}), 0xFFFF);
    EXPECT_EQ(crc32c({}), 0U);
}

TEST(Crc32c, MatchesReferenceAtEveryLengthAndSplit) {
    std::mt19937 random(1);
    for (std::size_t length = 0; length < 70; ++length) {
        std::vector<std::uint8_t> bytes(length);
        for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
        EXPECT_EQ(crc32c(bytes), crc32cBitwise(bytes));
        const std::size_t split = length == 0 ? 0 : random() % length;
        Crc32c pieces;
        pieces.add(std::span(bytes).first(split));
        pieces.add(std::span(bytes).subspan(split));
        EXPECT_EQ(pieces.value(), crc32c(bytes));
    }
}

TEST(Crc32c, InstructionMatchesTheTableAtEveryLengthAroundItsBlocks) {
    std::mt19937 random(2);
    std::vector<std::uint8_t> bytes(4 * 3 * 1024 + 9);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    const std::span<const std::uint8_t> all(bytes);
    for (const std::size_t block : {0U, 1U, 2U, 3U, 4U}) {
        for (std::size_t off = 0; off < 40; ++off) {
            const std::size_t length = std::min(block * 3072 + off, all.size());
            const std::size_t begin = std::min(off % 9, all.size() - length);
            const auto some = all.subspan(begin, length);
            EXPECT_EQ(crc32c(some), crc32cByTable(some)) << length;
        }
        const auto less = all.first(std::max<std::size_t>(block * 3072, 17) - 17);
        EXPECT_EQ(crc32c(less), crc32cByTable(less)) << less.size();
    }
    EXPECT_EQ(crc32cByTable(all), crc32cBitwise(bytes));
}

TEST(Crc16, SeesEveryBitAndEveryTranspositionOfNeighbours) {
    std::vector<std::uint8_t> bytes = digits();
    const std::uint16_t right = crc16(bytes);
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1U << (bit % 8)));
        EXPECT_NE(crc16(bytes), right) << bit;
        bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1U << (bit % 8)));
    }
    for (std::size_t i = 1; i < bytes.size(); ++i) {
        std::swap(bytes[i - 1], bytes[i]);
        EXPECT_NE(crc16(bytes), right) << i;
        std::swap(bytes[i - 1], bytes[i]);
    }
}

}  // namespace
}  // namespace gonio::driver
