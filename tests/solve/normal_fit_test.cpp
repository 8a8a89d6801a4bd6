#include "proc/solve/normal_fit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace {

using namespace gonio::proc;

constexpr std::array<double, 6> kX{0, 1, 2, 3, 4, 5};

/// y = a exp(b x) with an error of alternating sign, each value with sigma 0.01.
double residual(std::size_t i, double a, double b) {
    const double y = 2 * std::exp(-0.5 * kX[i]) + (i % 2 == 0 ? 0.004 : -0.004);
    return (a * std::exp(b * kX[i]) - y) / 0.01;
}

std::optional<NormalSums> decaySums(std::span<const double> p, Wanted) {
    NormalSums sums = NormalSums::zero(2);
    for (std::size_t i = 0; i < kX.size(); ++i) {
        const double e = std::exp(p[1] * kX[i]) / 0.01;
        const double r = residual(i, p[0], p[1]);
        const Eigen::Vector2d j(e, p[0] * kX[i] * e);
        sums.cost += r * r;
        sums.gradient += j * r;
        sums.matrix += j * j.transpose();
    }
    return sums;
}

NormalProblem decay() {
    return {.sums = decaySums,
            .residualCount = kX.size(),
            .start = {1, -0.1},
            .lower = {0, -3},
            .upper = {10, 3}};
}

/// The twin with all rows.
FitReport allRows() {
    FitProblem problem;
    problem.residualCount = kX.size();
    problem.start = {1, -0.1};
    problem.residuals = [](std::span<const double> p, std::span<double> r) {
        for (std::size_t i = 0; i < kX.size(); ++i) r[i] = residual(i, p[0], p[1]);
        return true;
    };
    return fit(problem);
}

TEST(NormalFit, MatchesTheFitToAllRows) {
    const NormalFit fit = fitNormal(decay());
    const FitReport reference = allRows();
    ASSERT_EQ(fit.status, FitStatus::Converged) << fit.message;
    ASSERT_TRUE(reference.ok());
    // A change of the cost by 1e-12 of it moves a parameter by 1e-6 of its uncertainty.
    EXPECT_NEAR(fit.params[0], reference.params[0], 1e-7);
    EXPECT_NEAR(fit.params[1], reference.params[1], 1e-7);
    EXPECT_LT((fit.covariance - reference.covariance).norm(), 1e-5 * reference.covariance.norm());
    EXPECT_NEAR(std::sqrt(fit.sums.cost / kX.size()), reference.rms, 1e-9);
}

TEST(NormalFit, HoldsWhatABoundHoldsAndFitsTheRest) {
    NormalProblem problem = decay();
    problem.lower[1] = -0.3;
    const NormalFit fit = fitNormal(problem);
    ASSERT_EQ(fit.status, FitStatus::Converged) << fit.message;
    EXPECT_NEAR(fit.params[1], -0.3, 1e-9);
    EXPECT_TRUE(fit.atBound[1]);
    EXPECT_FALSE(fit.atBound[0]);
    EXPECT_NEAR(fit.sums.gradient(0), 0, 1e-5 * std::sqrt(fit.sums.matrix(0, 0)));
    EXPECT_NEAR(fit.covariance(0, 0), 1 / fit.sums.matrix(0, 0), 1e-9 * fit.covariance(0, 0));
    EXPECT_TRUE(std::isnan(fit.covariance(1, 1)));
}

TEST(NormalFit, SaysWhereTheDataLeaveAParameterFree) {
    NormalProblem problem = decay();
    problem.sums = [](std::span<const double> p, Wanted) -> std::optional<NormalSums> {
        NormalSums sums = NormalSums::zero(2);
        const double r = p[0] + p[1] - 1;  // the sum alone
        sums.cost = r * r;
        sums.gradient = Eigen::Vector2d(r, r);
        sums.matrix = Eigen::Matrix2d::Ones();
        return sums;
    };
    const NormalFit fit = fitNormal(problem);
    EXPECT_EQ(fit.status, FitStatus::Singular) << fit.message;
    EXPECT_TRUE(fit.covariance.array().isNaN().all());
    EXPECT_NEAR(fit.params[0] + fit.params[1], 1, 1e-6);
}

TEST(NormalFit, RefusesTooFewDataAndAStartWithoutSums) {
    NormalProblem problem = decay();
    problem.residualCount = 1;
    EXPECT_EQ(fitNormal(problem).status, FitStatus::TooFewData);
    problem = decay();
    problem.sums = [](std::span<const double>, Wanted) { return std::optional<NormalSums>(); };
    const NormalFit fit = fitNormal(problem);
    EXPECT_EQ(fit.status, FitStatus::BadStart);
    EXPECT_TRUE(std::isnan(fit.params[0]));
    problem.sums = [](std::span<const double>, Wanted) {
        NormalSums sums = NormalSums::zero(2);
        sums.matrix(0, 1) = std::nan("");
        return std::optional(sums);
    };
    EXPECT_EQ(fitNormal(problem).status, FitStatus::BadStart);
}

}  // namespace
