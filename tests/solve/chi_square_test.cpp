#include "proc/solve/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using gonio::proc::chiSquareTail;

TEST(ChiSquare, TwoDegreesOfFreedomAreAnExponential) {
    for (const double x : {1e-6, 0.5, 1.0, 5.0, 20.0, 100.0, 600.0}) {
        EXPECT_NEAR(chiSquareTail(x, 2), std::exp(-x / 2), 1e-12 * std::exp(-x / 2)) << x;
    }
}

TEST(ChiSquare, OneDegreeOfFreedomIsTheTailOfTheNormalDistribution) {
    for (const double x : {1e-4, 0.1, 1.0, 3.8414588, 6.6348966, 25.0, 100.0}) {
        const double expected = std::erfc(std::sqrt(x / 2));
        EXPECT_NEAR(chiSquareTail(x, 1), expected, 1e-12 * expected + 1e-15) << x;
    }
}

/// Of an even number of degrees it is a finite sum, e^(-x/2) sum_(j < dof/2) (x/2)^j / j!: worked
/// out to 60 digits.
TEST(ChiSquare, IsTheFiniteSumOfEvenDegrees) {
    const struct {
        double dof, x, tail;
    } exact[] = {{10, 3, 0.98142406377785929},
                 {10, 40, 1.6944743930067385e-05},
                 {100, 80, 0.92966493334060507},
                 {100, 180, 1.6494985017178249e-06},
                 {1000, 1000, 0.49405285382923964},
                 {1000, 1300, 3.8897364994868526e-10},
                 {10000, 9900, 0.75952008568397933},
                 {10000, 10000, 0.49811936596618267},
                 {10000, 11000, 3.6183295580964791e-12},
                 {1000000, 1000000, 0.49981193680339447},
                 {1000000, 1005000, 0.00020767800946703004},
                 {1000000, 1010000, 9.0685288232620768e-13}};
    for (const auto& one : exact) {
        const double bound = one.dof > 1e4 ? 1e-9 : 1e-12;
        EXPECT_NEAR(chiSquareTail(one.x, one.dof), one.tail, bound * one.tail)
            << one.x << " " << one.dof;
    }
}

TEST(ChiSquare, OfNoNumberIsNone) { EXPECT_TRUE(std::isnan(chiSquareTail(std::nan(""), 3))); }

TEST(ChiSquare, FallsFromOneToZero) {
    EXPECT_EQ(chiSquareTail(0, 3), 1);
    EXPECT_EQ(chiSquareTail(-5, 3), 1);
    EXPECT_EQ(chiSquareTail(1e6, 3), 0);
    double before = 1;
    for (double x = 0.1; x < 60; x += 0.1) {
        const double tail = chiSquareTail(x, 11);
        EXPECT_LT(tail, before);
        before = tail;
    }
}

}  // namespace
