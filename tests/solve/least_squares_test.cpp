#include "proc/solve/least_squares.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

namespace {

using namespace gonio::proc;

constexpr std::array<double, 5> kX{0, 1, 2, 3, 4};

/// y = a exp(b x), exact at a = 2, b = -0.5, each value with sigma 0.01.
bool decay(std::span<const double> p, std::span<double> r) {
    for (std::size_t i = 0; i < kX.size(); ++i)
        r[i] = (p[0] * std::exp(p[1] * kX[i]) - 2 * std::exp(-0.5 * kX[i])) / 0.01;
    return true;
}

bool decayJacobian(std::span<const double> p, Eigen::MatrixXd& j) {
    for (std::size_t i = 0; i < kX.size(); ++i) {
        const double e = std::exp(p[1] * kX[i]) / 0.01;
        j(static_cast<Eigen::Index>(i), 0) = e;
        j(static_cast<Eigen::Index>(i), 1) = p[0] * kX[i] * e;
    }
    return true;
}

FitProblem decayProblem() {
    FitProblem problem;
    problem.residuals = decay;
    problem.residualCount = kX.size();
    problem.start = {1, -0.1};
    return problem;
}

TEST(LeastSquares, FindsTheExactMinimum) {
    const FitReport report = fit(decayProblem());
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_NEAR(report.params[0], 2, 1e-8);
    EXPECT_NEAR(report.params[1], -0.5, 1e-8);
    EXPECT_NEAR(report.rms, 0, 1e-6);
    EXPECT_GT(report.iterations, 1);
}

TEST(LeastSquares, CentralDifferencesMatchTheJacobian) {
    FitProblem exact = decayProblem();
    exact.jacobian = decayJacobian;
    const FitReport numeric = fit(decayProblem());
    const FitReport analytic = fit(exact);
    ASSERT_TRUE(numeric.ok() && analytic.ok());
    // Central differences with Ceres' relative step of 1e-6: error of order step^2 and ulp / step.
    EXPECT_LT((numeric.covariance - analytic.covariance).norm(), 1e-6 * analytic.covariance.norm());
}

TEST(LeastSquares, CovarianceIsTheInverseOfTheNormalMatrix) {
    FitProblem line;
    line.residualCount = kX.size();
    line.start = {0, 0};
    line.residuals = [](std::span<const double> p, std::span<double> r) {
        for (std::size_t i = 0; i < kX.size(); ++i) r[i] = (p[0] + p[1] * kX[i] - 1) / 0.5;
        return true;
    };
    const FitReport report = fit(line);
    ASSERT_TRUE(report.ok());
    // Textbook line fit: n = 5, sum x = 10, sum x^2 = 30, sigma = 0.5.
    const double det = 5 * 30 - 10 * 10;
    EXPECT_NEAR(report.covariance(0, 0), 0.25 * 30 / det, 1e-8);
    EXPECT_NEAR(report.covariance(1, 1), 0.25 * 5 / det, 1e-8);
    EXPECT_NEAR(report.covariance(0, 1), -0.25 * 10 / det, 1e-8);
}

TEST(LeastSquares, StaysWithinItsBounds) {
    FitProblem problem = decayProblem();
    problem.lower = {0, -0.3};
    problem.upper = {10, 0};
    const FitReport report = fit(problem);
    EXPECT_GE(report.params[1], -0.3);
    EXPECT_NEAR(report.params[1], -0.3, 1e-6);
}

TEST(LeastSquares, SaysWhereTheDataLeaveAParameterFree) {
    FitProblem problem = decayProblem();
    problem.start = {1, 1};
    problem.residuals = [](std::span<const double> p, std::span<double> r) {
        for (std::size_t i = 0; i < kX.size(); ++i) r[i] = p[0] + p[1] - kX[i];  // the sum alone
        return true;
    };
    const FitReport report = fit(problem);
    EXPECT_EQ(report.status, FitStatus::Singular) << name(report.status);
    EXPECT_TRUE(report.covariance.array().isNaN().all());
}

TEST(LeastSquares, RefusesFewerResidualsThanParameters) {
    FitProblem problem = decayProblem();
    problem.residualCount = 1;
    const FitReport report = fit(problem);
    EXPECT_EQ(report.status, FitStatus::TooFewData);
    EXPECT_TRUE(std::isnan(report.params[0]) && std::isnan(report.rms));
}

TEST(LeastSquares, RefusesAStartWithoutResiduals) {
    FitProblem problem = decayProblem();
    problem.residuals = [](std::span<const double>, std::span<double>) { return false; };
    EXPECT_EQ(fit(problem).status, FitStatus::BadStart);
    problem.residuals = [](std::span<const double>, std::span<double> r) {
        for (double& v : r) v = std::nan("");
        return true;
    };
    const FitReport report = fit(problem);
    EXPECT_EQ(report.status, FitStatus::BadStart);
    EXPECT_TRUE(std::isnan(report.params[0]));
}

TEST(LeastSquares, NeverCallsAnUnfinishedFitConverged) {
    FitProblem problem = decayProblem();
    problem.start = {100, 1};
    problem.maxIterations = 1;
    EXPECT_EQ(fit(problem).status, FitStatus::NotConverged);
}

TEST(LeastSquares, GivesTheSameBitsEachTime) {
    const FitReport a = fit(decayProblem());
    const FitReport b = fit(decayProblem());
    EXPECT_EQ(a.params, b.params);
    EXPECT_EQ(a.covariance, b.covariance);
    EXPECT_EQ(a.iterations, b.iterations);
}

TEST(FitStatus, EachHasANameOfItsOwn) {
    std::set<std::string_view> names;
    for (FitStatus status : {FitStatus::Converged,
                             FitStatus::Singular,
                             FitStatus::TooFewData,
                             FitStatus::BadStart,
                             FitStatus::NotConverged}) {
        EXPECT_FALSE(name(status).empty());
        names.insert(name(status));
    }
    EXPECT_EQ(names.size(), 5U);
}

}  // namespace
