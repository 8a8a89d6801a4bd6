#include "proc/report/report_words.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const std::string kPm = " \xC2\xB1 ";

TEST(ReportWords, AValueHasNoMoreDigitsThanItsExpandedUncertaintyAllows) {
    EXPECT_EQ(withExpanded(0.717049, 0.0026), "0.7170" + kPm + "0.0052");
    EXPECT_EQ(withExpanded(0.3, 0.05), "0.30" + kPm + "0.10");
    EXPECT_EQ(withExpanded(0.3, 0.0498), "0.30" + kPm + "0.10") << "rounds up a decade";
    EXPECT_EQ(withExpanded(1234.5, 60), "1230" + kPm + "120");
    EXPECT_EQ(withExpanded(3.1e-4, 3.3e-5), "(3.10" + kPm + "0.66)e-4");
    EXPECT_EQ(withExpanded(2.5e7, 1e6), "(2.50" + kPm + "0.20)e7");
    EXPECT_EQ(withExpanded(-0.0001, 0.01), "0.000" + kPm + "0.020") << "no minus nothing";
    EXPECT_EQ(withExpanded(-3, 170), "0" + kPm + "340") << "nor left of the point";
    EXPECT_EQ(withExpanded(1e-9, 0.5), "0.0" + kPm + "1.0");
}

TEST(ReportWords, WhatIsNotKnownIsSaid) {
    EXPECT_EQ(withExpanded(kNan, 0.1), "none");
    EXPECT_EQ(withExpanded(HUGE_VAL, 0.1), "none");
    EXPECT_EQ(withExpanded(0.12345, std::nullopt), "0.123 (u not known)");
    EXPECT_EQ(withExpanded(0.12345, kNan), "0.123 (u not known)");
    EXPECT_EQ(withExpanded(0.25, 0), "0.250000" + kPm + "0");
    EXPECT_EQ(relativeText(kNan), "none");
    EXPECT_EQ(shareText(kNan), "none");
}

TEST(ReportWords, SharesAndSignificantDigits) {
    EXPECT_EQ(relativeText(0.00523), "0.52 %");
    EXPECT_EQ(relativeText(0.0999), "10 %");
    EXPECT_EQ(relativeText(0), "0");
    EXPECT_EQ(shareText(0.73351), "73.4 %");
    EXPECT_EQ(shareText(1e-5), "< 0.1 %");
    EXPECT_EQ(shareText(0), "0");
    EXPECT_EQ(shareText(-1e-16), "0");
    EXPECT_EQ(shareText(1e-10), "0") << "rounding of a sum";
    EXPECT_EQ(significant(123456, 2), "120000");
    EXPECT_EQ(significant(1.5e12, 2), "1.5e12");
    EXPECT_EQ(significant(3.2e-6, 2), "3.2e-6");
    EXPECT_EQ(significant(std::numeric_limits<double>::min(), 2), "2.2e-308");
    EXPECT_EQ(significant(9.96, 2), "10");
}

}  // namespace
}  // namespace gonio::proc
