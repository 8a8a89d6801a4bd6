#include "proc/fit/chi_square.h"

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

TEST(ChiSquare, HasHalfItsProbabilityAtTheMedianOfManyDegrees) {
    // Wilson and Hilferty's median dof (1 - 2 / (9 dof))^3; its error falls as 1 / dof^(3/2).
    for (const double dof : {100.0, 1e4, 1e6}) {
        const double median = dof * std::pow(1 - 2 / (9 * dof), 3);
        EXPECT_NEAR(chiSquareTail(median, dof), 0.5, 1e-3) << dof;
    }
}

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
