#include "proc/formats/json_scan.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gonio::proc {
namespace {

/// Walks to the end; the fault, or empty.
std::string faultOf(std::string_view text) {
    JsonScan scan(text);
    for (;;) {
        const JsonToken token = scan.next();
        if (token == JsonToken::End) return "";
        if (token == JsonToken::Bad) return scan.fault();
    }
}

std::string textOf(std::string_view json) {
    JsonScan scan(json);
    EXPECT_EQ(scan.next(), JsonToken::String);
    return scan.text();
}

TEST(JsonScan, WalksOverEveryKindOfValue) {
    JsonScan scan(R"( {"a": [1, -2.5e-3, "x"], "b" : {}, "c": [] , "d": null} )");
    EXPECT_EQ(scan.next(), JsonToken::ObjectBegin);
    EXPECT_EQ(scan.next(), JsonToken::Key);
    EXPECT_EQ(scan.text(), "a");
    EXPECT_EQ(scan.next(), JsonToken::ArrayBegin);
    EXPECT_EQ(scan.next(), JsonToken::Number);
    EXPECT_EQ(scan.next(), JsonToken::Number);
    EXPECT_EQ(scan.number(), -2.5e-3);
    EXPECT_EQ(scan.next(), JsonToken::String);
    EXPECT_EQ(scan.next(), JsonToken::ArrayEnd);
    EXPECT_EQ(scan.next(), JsonToken::Key);
    EXPECT_TRUE(scan.skipValue());
    EXPECT_EQ(scan.next(), JsonToken::Key);
    EXPECT_TRUE(scan.skipValue());
    EXPECT_EQ(scan.next(), JsonToken::Key);
    EXPECT_EQ(scan.next(), JsonToken::Literal);
    EXPECT_EQ(scan.raw(), "null");
    EXPECT_EQ(scan.next(), JsonToken::ObjectEnd);
    EXPECT_EQ(scan.next(), JsonToken::End);
}

TEST(JsonScan, ResolvesEscapes) {
    EXPECT_EQ(textOf(R"("a\"\\\/\n\t")"), "a\"\\/\n\t");
    EXPECT_EQ(textOf(R"("\u00b5\u20AC")"), "\xC2\xB5\xE2\x82\xAC");
    EXPECT_EQ(textOf(R"("\ud83d\ude00!")"), "\xF0\x9F\x98\x80!");
    // Halves of pairs alone, and no digits: U+FFFD, and nothing beyond the string is read.
    EXPECT_EQ(textOf(R"("\ud83dx")"), "\xEF\xBF\xBDx");
    EXPECT_EQ(textOf(R"("\udc00")"), "\xEF\xBF\xBD");
    EXPECT_EQ(textOf(R"("\u12")"), "\xEF\xBF\xBD");
    for (const std::string text : {"a\"b\\c\nd\te\x01", "\xC2\xB5"}) {
        EXPECT_EQ(textOf(jsonString(text)), text);
    }
}

TEST(JsonScan, ReadsNumbersAtOnce) {
    JsonScan scan("[1, 2.5 ,null,-3e2]x");
    ASSERT_EQ(scan.next(), JsonToken::ArrayBegin);
    std::vector<double> numbers;
    ASSERT_TRUE(scan.numbers(numbers, true));
    ASSERT_EQ(numbers.size(), 4U);
    EXPECT_EQ(numbers[3], -300);
    EXPECT_TRUE(std::isnan(numbers[2]));
    EXPECT_EQ(scan.next(), JsonToken::Bad);
    for (const char* wrong : {"[1 2]", "[1,]", "[,1]", "[1", "[null]", "[nan]", "[1e999]"}) {
        JsonScan other(wrong);
        (void)other.next();
        numbers.clear();
        EXPECT_FALSE(other.numbers(numbers)) << wrong;
        EXPECT_FALSE(other.fault().empty());
    }
}

TEST(JsonScan, SaysWhatIsWrong) {
    for (const char* wrong :
         {"",      "{",  "[",  "{\"a\"}", "{\"a\":}", "{a:1}",    "{\"a\":1,}", "[1,]",
          "[1 2]", "[}", "{]", "\"a",     "\"a\\",    "\"a\nb\"", "tru",        "01x",
          "-",     "+1", ".5", "1 1",     "[1]]",     "{\"a\" 1}"}) {
        EXPECT_FALSE(faultOf(wrong).empty()) << wrong;
    }
    EXPECT_EQ(faultOf("[" + std::string(63, '[') + std::string(64, ']')), "");
    EXPECT_EQ(faultOf(std::string(65, '[')), "nested deeper than 64");
    JsonScan scan("\xEF\xBB\xBF[1,\r\n2,\r3,\nx]");
    while (scan.next() != JsonToken::Bad) continue;
    EXPECT_EQ(scan.line(), 4U);
}

}  // namespace
}  // namespace gonio::proc
