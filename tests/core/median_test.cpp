#include "proc/core/median.h"

#include <gtest/gtest.h>

namespace gonio {
namespace {

TEST(Median, IsTheMiddleOfThemInAnyOrder) {
    EXPECT_EQ(median(std::vector{3.0, 1.0, 2.0}), 2);
    EXPECT_EQ(median(std::vector{7.0F}), 7);
    EXPECT_EQ(median(std::vector{4.0, 1.0, 3.0, 2.0}), 3);  // the upper of two middles
}

TEST(Median, OfNothingIsNoNumber) { EXPECT_TRUE(std::isnan(median(std::vector<double>{}))); }

}  // namespace
}  // namespace gonio
