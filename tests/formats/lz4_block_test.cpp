#include "proc/formats/lz4_block.h"

#include <gtest/gtest.h>

namespace gonio::proc {
namespace {

using namespace std::string_literals;

TEST(Lz4Block, CopiesWhatWasDecodedBefore) {
    EXPECT_EQ(decodeLz4("\x00"s, 0), "");
    EXPECT_EQ(decodeLz4("\x30"
                        "abc"s,
                        3),
              "abc");
    EXPECT_EQ(decodeLz4("\x30"
                        "abc\x03\x00\x10z"s,
                        8),
              "abcabcaz");  // the shortest copy is 4 bytes
    EXPECT_EQ(decodeLz4("\x32"
                        "abc\x03\x00\x10z"s,
                        10),
              "abcabcabcz");  // 2 + 4 bytes from 3 back: the copy overlaps itself
    EXPECT_EQ(decodeLz4("\x1F"
                        "a\x01\x00\x05\x10"
                        "b"s,
                        26),
              std::string(25, 'a') + "b");  // 15 + 5 + 4
}

TEST(Lz4Block, ReadsLongLiterals) {
    const std::string text(15 + 255 + 7, 'x');
    EXPECT_EQ(decodeLz4("\xF0\xFF\x07"s + text, text.size()), text);
}

TEST(Lz4Block, RefusesEveryOtherSizeAndEveryCut) {
    const std::string block =
        "\x32"
        "abc\x03\x00\x10z"s;
    for (std::size_t size = 0; size < 20; ++size) {
        EXPECT_EQ(decodeLz4(block, size).has_value(), size == 10) << size;
    }
    for (std::size_t cut = 0; cut < block.size(); ++cut) {
        EXPECT_FALSE(decodeLz4(std::string_view(block).substr(0, cut), 10)) << cut;
    }
}

TEST(Lz4Block, RefusesCopiesFromBeforeItsStart) {
    EXPECT_FALSE(
        decodeLz4("\x32"
                  "abc\x04\x00\x10z"s,
                  10));
    EXPECT_FALSE(
        decodeLz4("\x32"
                  "abc\x00\x00\x10z"s,
                  10));
    EXPECT_FALSE(decodeLz4("\x0F\x01\x00\xFF\xFF\xFF"s, 1000));
    EXPECT_FALSE(decodeLz4("\xF0\xFF\xFF\xFF\xFF"s, 10));
}

}  // namespace
}  // namespace gonio::proc
