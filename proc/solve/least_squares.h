#pragma once
// Non-linear least squares: the only door to Ceres. In: a residual function r(p), each residual
// already divided by its standard deviation, a start, and where wanted bounds on p. Out: the p that
// minimises sum r^2, its covariance (J^T J)^-1, and a status that must be looked at. One thread per
// fit, so the same input gives the same bits.
//
// Every output is poisoned with NaN before the solve and checked after it: a fit that failed never
// looks like one that worked. With fewer residuals than parameters: TooFewData. Where the data
// leave a combination of parameters free: Singular, with the parameters but without a covariance. A
// residual that is not finite at the start: BadStart. A parameter that ends on its bound is held
// there by the bound, and the covariance is that of the free problem.

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::proc {

enum class FitStatus {
    Converged,
    Singular,
    TooFewData,
    BadStart,
    NotConverged,
};
[[nodiscard]] std::string_view name(FitStatus status);

struct FitProblem {
    /// Writes all residuals for the parameters; returns false where the model has no value.
    using Residuals = std::function<bool(std::span<const double> parameters, std::span<double>)>;
    /// Writes d r_i / d p_j at row i, column j; the matrix comes in the right size.
    using Jacobian = std::function<bool(std::span<const double> parameters, Eigen::MatrixXd&)>;

    Residuals residuals;
    std::size_t residualCount = 0;
    std::vector<double> start;
    Jacobian jacobian;          ///< empty: central differences
    std::vector<double> lower;  ///< empty: unbounded; else one per parameter
    std::vector<double> upper;
    int maxIterations = 200;
};

struct FitReport {
    std::vector<double> params;
    Eigen::MatrixXd covariance;  ///< NaN unless Converged
    double rms = 0;              ///< of the residuals; 1 where the sigmas are right, dof aside
    FitStatus status = FitStatus::NotConverged;
    int iterations = 0;
    std::string message;

    [[nodiscard]] bool ok() const { return status == FitStatus::Converged; }
};

[[nodiscard]] FitReport fit(const FitProblem& problem);

}  // namespace gonio::proc
