#include "proc/solve/quadrature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace gonio::proc {
namespace {

template <class F>
double integral(const std::vector<QuadratureNode>& rule, F&& f) {
    double sum = 0;
    for (const QuadratureNode& node : rule) sum += node.weight * f(node.x);
    return sum;
}

TEST(GaussLegendre, IsExactForPolynomialsOfDegreeTwiceTheNodesLessOne) {
    for (const std::size_t n : {1U, 2U, 3U, 5U, 16U, 64U}) {
        const auto rule = gaussLegendre(n);
        ASSERT_EQ(rule.size(), n);
        for (std::size_t degree = 0; degree < 2 * n; ++degree) {
            const auto k = static_cast<double>(degree);
            const double found = integral(rule, [&](double x) { return std::pow(x, k); });
            EXPECT_NEAR(found, 1 / (k + 1), 4e-15) << n << " " << degree;
        }
        // And not beyond: x^(2n) misses by (n!)^4 / ((2n + 1) (2n)!^2), seen for few nodes.
        if (n > 5) continue;
        const auto m = static_cast<double>(n);
        const double missed =
            integral(rule, [&](double x) { return std::pow(x, 2 * m); }) - 1 / (2 * m + 1);
        const double expected =
            -std::exp(4 * std::lgamma(m + 1) - 2 * std::lgamma(2 * m + 1)) / (2 * m + 1);
        EXPECT_NEAR(missed, expected, 1e-6 * std::abs(expected) + 1e-16) << n;
    }
}

TEST(GaussLegendre, NodesAreInsideAndDifferAndWeightsArePositive) {
    for (std::size_t n = 1; n < 40; ++n) {
        std::set<double> seen;
        for (const QuadratureNode& node : gaussLegendre(n)) {
            EXPECT_TRUE(seen.insert(node.x).second) << n;
            EXPECT_GT(node.x, 0);
            EXPECT_LT(node.x, 1);
            EXPECT_GT(node.weight, 0);
        }
    }
}

TEST(TanhSinh, ReachesRoundingForSmoothIntegrands) {
    const auto rule = tanhSinh(25);
    EXPECT_EQ(rule.size(), 51U);
    EXPECT_NEAR(integral(rule, [](double) { return 1.0; }), 1, 1e-14);
    EXPECT_NEAR(integral(rule, [](double x) { return std::exp(x); }), std::exp(1) - 1, 3e-14);
}

TEST(TanhSinh, BearsSingularEnds) {
    const auto rule = tanhSinh(40);
    // The root ends at x = 2e-17, where 2 sqrt(x) of it is left out.
    EXPECT_NEAR(integral(rule, [](double x) { return 1 / std::sqrt(x); }), 2, 2e-8);
    EXPECT_NEAR(integral(rule, [](double x) { return std::log(x); }), -1, 1e-13);
    EXPECT_NEAR(integral(rule, [](double x) { return std::sqrt(x); }), 2.0 / 3, 1e-14);
}

}  // namespace
}  // namespace gonio::proc
