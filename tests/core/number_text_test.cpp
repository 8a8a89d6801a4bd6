#include "proc/core/number_text.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace gonio {
namespace {

TEST(NumberText, ReadsWholeFiniteNumbersOnly) {
    EXPECT_EQ(parseDouble("1.5e-3"), 1.5e-3);
    EXPECT_EQ(parseDouble("+2"), 2.0);
    EXPECT_EQ(parseDouble("-0.25"), -0.25);
    for (const char* bad :
         {"", "banana", "1.5x", "1,5", " 1", "1 ", "nan", "inf", "1e400", "+-1", "+"}) {
        EXPECT_FALSE(parseDouble(bad)) << bad;
    }
}

TEST(NumberText, ReadsWholeIntegersOnly) {
    EXPECT_EQ(parseInteger("-12"), -12);
    for (const char* bad : {"", "1.0", "12a", "99999999999999999999"}) {
        EXPECT_FALSE(parseInteger(bad)) << bad;
    }
}

TEST(NumberText, ShortestReadsBackToTheSameBits) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 20000; ++i) {
        const double value = std::bit_cast<double>(random());
        if (!std::isfinite(value)) continue;
        const auto back = parseDouble(shortest(value));
        ASSERT_TRUE(back);
        EXPECT_EQ(std::bit_cast<std::uint64_t>(*back), std::bit_cast<std::uint64_t>(value));
    }
    EXPECT_EQ(shortest(0.1), "0.1");
    EXPECT_EQ(shortest(0.1F), "0.1");
}

TEST(NumberText, AppendsTheShortestDigits) {
    std::string text = "f ";
    for (const double value :
         {0.1, -std::numeric_limits<double>::min(), std::numeric_limits<double>::infinity()}) {
        const std::string before = text;
        appendShortest(text, value);
        EXPECT_EQ(text, before + shortest(value));
    }
}

TEST(NumberText, LeadsWithWhatIsANumberByItself) {
    for (const char* number : {"1", "-2.5e-3", "+7", "0.1", "5e-324"}) {
        for (const char* rest : {"", " 2", "\t", ",5", "x"}) {
            const auto leading = leadingDouble(std::string(number) + rest);
            ASSERT_TRUE(leading) << number << rest;
            EXPECT_EQ(leading->value, *parseDouble(number));
            EXPECT_EQ(leading->length, std::string_view(number).size());
        }
    }
    for (const char* none : {"", " 1", "x", "+", "+-1", "-", "nan", "inf 1", "1e999", "."}) {
        EXPECT_FALSE(leadingDouble(none)) << none;
    }
}

TEST(NumberText, SaysWhatIsNoNumber) {
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_EQ(shortest(std::numeric_limits<double>::quiet_NaN()), "nan");
    EXPECT_EQ(shortest(inf), "inf");
    EXPECT_EQ(shortest(-inf), "-inf");
    EXPECT_FALSE(parseDouble(shortest(inf)));  // and never reads it back as one
}

TEST(NumberText, FixedHoldsTheLargestDouble) {
    EXPECT_EQ(fixed(2.345, 2), "2.35");
    EXPECT_EQ(fixed(std::numeric_limits<double>::max(), 2).size(), 312U);
}

TEST(NumberText, FractionsAreShownInPerCent) {
    EXPECT_EQ(perCent(0.0125), "1.25 %");
    EXPECT_EQ(perCent(1), "100.00 %");
    EXPECT_EQ(perCent(-0.05), "-5.00 %");
}

}  // namespace
}  // namespace gonio
