#include "proc/solve/gauss_kronrod.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gonio::proc {
namespace {

struct Sums {
    double kronrod = 0;
    double gauss = 0;
};

Sums ofPower(int degree) {
    Sums sums;
    for (const KronrodNode& node : gaussKronrod()) {
        // About the middle: at the ends a high power would see one node only.
        const double value = std::pow(2 * node.x - 1, degree);
        sums.kronrod += node.kronrod * value;
        sums.gauss += node.gauss * value;
    }
    return sums;
}

double exact(int degree) { return degree % 2 == 0 ? 1.0 / (degree + 1) : 0.0; }

TEST(GaussKronrod, IsExactToDegree23AndItsGaussRuleToDegree13) {
    for (int degree = 0; degree <= 23; ++degree) {
        EXPECT_NEAR(ofPower(degree).kronrod, exact(degree), 1e-15) << degree;
        if (degree <= 13) {
            EXPECT_NEAR(ofPower(degree).gauss, exact(degree), 1e-15) << degree;
        }
    }
}

TEST(GaussKronrod, IsNoLongerExactBeyond) {
    EXPECT_GT(std::abs(ofPower(14).gauss - exact(14)), 1e-5);
    EXPECT_GT(std::abs(ofPower(24).kronrod - exact(24)), 1e-10);
}

TEST(GaussKronrod, DifferenceOfTheRulesBoundsTheErrorOfTheFiner) {
    Sums sums;
    for (const KronrodNode& node : gaussKronrod()) {
        sums.kronrod += node.kronrod * std::exp(5 * node.x);
        sums.gauss += node.gauss * std::exp(5 * node.x);
    }
    const double error = std::abs(sums.kronrod - std::expm1(5) / 5);
    EXPECT_LT(error, std::abs(sums.kronrod - sums.gauss));
}

}  // namespace
}  // namespace gonio::proc
