#include "sim/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace gonio::sim {
namespace {

struct Moments {
    double mean, variance, skewness;
};

template <class Draw>
Moments momentsOf(int n, Draw draw) {
    double s1 = 0, s2 = 0, s3 = 0;
    for (int i = 0; i < n; ++i) {
        const double x = draw(static_cast<std::uint64_t>(i));
        s1 += x;
        s2 += x * x;
        s3 += x * x * x;
    }
    const double mean = s1 / n;
    const double variance = s2 / n - mean * mean;
    const double third = s3 / n - 3 * mean * s2 / n + 2 * mean * mean * mean;
    return {mean, variance, third / std::pow(variance, 1.5)};
}

constexpr int kDraws = 400'000;  // standard error of a mean: sigma / 632

TEST(Random, GaussianHasStandardMoments) {
    const Moments m = momentsOf(kDraws, [](std::uint64_t i) { return gaussian(1, i); });
    EXPECT_NEAR(m.mean, 0, 0.007);
    EXPECT_NEAR(m.variance, 1, 0.01);
    EXPECT_NEAR(m.skewness, 0, 0.02);
}

TEST(Random, QuantileIsTheInverseOfTheDistribution) {
    for (double x = -8; x <= 8; x += 0.25) {
        const double u = 0.5 * std::erfc(-x / std::sqrt(2.0));
        // Near 1 the argument itself has lost the digits.
        const double tolerance = 2e-9 * std::abs(x) + 1e-9 + (x > 5 ? 0.5 : 0);
        EXPECT_NEAR(normalQuantile(u), x, tolerance);
    }
}

TEST(Random, PoissonHasItsMomentsOnBothSidesOfTheThreshold) {
    for (double mean : {0.0, 0.1, 0.5, 5.0, 9.9, 10.0, 10.1, 100.0, 10000.0}) {
        const Moments m =
            momentsOf(kDraws, [&](std::uint64_t i) { return poisson(mean, uniform(7, i)); });
        const double sigma = std::sqrt(mean);
        EXPECT_NEAR(m.mean, mean, 0.008 * sigma);
        EXPECT_NEAR(m.variance, mean, 0.02 * mean + 0.02 * sigma);
        if (mean > 1) {
            EXPECT_NEAR(m.skewness, 1 / sigma, 0.03);
        }
    }
}

/// The largest u that draws at most k: what poisson() takes the distribution function to be.
double distributionAt(double mean, double k) {
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double u = (low + high) / 2;
        (poisson(mean, u) <= k ? low : high) = u;
    }
    return low;
}

TEST(Random, PoissonJustAboveTenIsWrongByNoMoreThanItSays) {
    double worstBefore = 3e-4;
    for (double mean : {10.01, 30.0, 300.0}) {
        double term = std::exp(-mean), exact = 0, before = 0;
        double worst = 0, sum = 0, squares = 0;
        for (double k = 0; k < mean + 9 * std::sqrt(mean); ++k) {
            exact += term;
            term *= mean / (k + 1);
            const double drawn = distributionAt(mean, k);
            worst = std::max(worst, std::abs(drawn - exact));
            sum += k * (drawn - before);
            squares += (k - mean) * (k - mean) * (drawn - before);
            before = drawn;
        }
        EXPECT_LT(worst, worstBefore) << mean;
        EXPECT_NEAR(sum / mean, 1, 1e-4) << mean;
        EXPECT_NEAR(squares / mean, 1, 1e-4) << mean;
        worstBefore = worst;
    }
}

TEST(Random, PoissonBelowTenIsExact) {
    for (double mean : {1e-12, 1e-3, 0.7, 1.0, 1.3, 9.99}) {
        double term = std::exp(-mean), exact = 0;
        for (double k = 0; k < 40; ++k) {
            exact += term;
            term *= mean / (k + 1);
            EXPECT_NEAR(distributionAt(mean, k), exact, 1e-14) << mean << ' ' << k;
        }
    }
}

TEST(Random, PoissonOfAHugeMeanIsTheMean) {
    for (double mean : {1e16, 1e19, 1e300}) EXPECT_NEAR(poisson(mean, 0.3) / mean, 1, 1e-8);
    EXPECT_EQ(poisson(0, 1 - 0x1p-53), 0);
}

TEST(Random, IsAPureFunctionOfKeyAndCounter) {
    EXPECT_EQ(uniform(3, 4), uniform(3, 4));
    EXPECT_NE(uniform(3, 4), uniform(3, 5));
    EXPECT_NE(mixed(1, 2), mixed(2, 1));
}

TEST(Random, UniformFillsTheOpenIntervalEvenly) {
    constexpr int kCells = 20, kCount = 200'000;
    std::array<int, kCells> seen{};
    for (std::uint64_t i = 0; i < kCount; ++i) {
        const double u = uniform(12, i);
        ASSERT_TRUE(u > 0 && u < 1);
        ++seen[static_cast<std::size_t>(u * kCells)];
    }
    // Binomial: sigma = sqrt(n p (1 - p)).
    const double sigma = std::sqrt(kCount * 0.05 * 0.95);
    for (int count : seen) EXPECT_NEAR(count, kCount / kCells, 5 * sigma);
}

}  // namespace
}  // namespace gonio::sim
