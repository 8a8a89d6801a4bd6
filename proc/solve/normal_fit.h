#pragma once
// Least squares from sums alone, for many residuals and few parameters: the caller gives, at p, the
// cost sum rho(r^2), its half gradient J^T W r and the matrix J^T W J (W = rho'), and never a row
// of J. Ceres minimises a problem of n + 1 residuals that has the same cost, gradient and matrix,
// so that it takes the steps that it would take with all rows.
//
// What fit() promises holds here: outputs are poisoned, TooFewData, BadStart, NotConverged. A
// parameter that ends on its bound is held there and the others are fitted again without it; it is
// named in `atBound`. The covariance is (J^T W J)^-1 of those that are free, NaN in the rows of
// those that are held; where the free ones leave a combination undetermined: Singular, with the
// parameters but without a covariance.

#include <optional>

#include "proc/solve/least_squares.h"

namespace gonio::proc {

struct NormalSums {
    double cost = 0;           ///< sum of rho(r^2)
    Eigen::VectorXd gradient;  ///< J^T W r
    Eigen::MatrixXd matrix;    ///< J^T W J

    [[nodiscard]] static NormalSums zero(std::size_t parameters);
    [[nodiscard]] bool finite() const;
};

enum class Wanted {
    Cost,
    Derivatives
};

struct NormalProblem {
    /// Empty where the model has no value. With Wanted::Cost only the cost is read.
    using Sums = std::function<std::optional<NormalSums>(std::span<const double>, Wanted)>;

    Sums sums;
    std::size_t residualCount = 0;
    std::vector<double> start;
    std::vector<double> lower;  ///< one per parameter; equal to the upper one: held there
    std::vector<double> upper;
    int maxIterations = 100;
    double tolerance = 1e-12;  ///< relative change of the cost that ends the search
};

struct NormalFit {
    std::vector<double> params;
    std::vector<bool> atBound;
    NormalSums sums;             ///< at the solution
    Eigen::MatrixXd covariance;  ///< NaN where held or not determined
    /// Largest over smallest eigenvalue of J^T W J, free parameters, columns scaled to length 1.
    double condition = 0;
    FitStatus status = FitStatus::NotConverged;
    int iterations = 0;
    std::string message;

    [[nodiscard]] bool usable() const {
        return status == FitStatus::Converged || status == FitStatus::Singular;
    }
};

[[nodiscard]] NormalFit fitNormal(const NormalProblem& problem);

}  // namespace gonio::proc
