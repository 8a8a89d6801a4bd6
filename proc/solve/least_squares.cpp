#include "proc/solve/least_squares.h"

#include <ceres/ceres.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// What Ceres calls for the residuals alone.
struct ResidualCall {
    const FitProblem* problem;

    bool operator()(const double* const* parameters, double* residuals) const {
        const std::span<const double> p(parameters[0], problem->start.size());
        const std::span<double> r(residuals, problem->residualCount);
        return problem->residuals(p, r) &&
               std::all_of(r.begin(), r.end(), [](double v) { return std::isfinite(v); });
    }
};

class AnalyticCost : public ceres::CostFunction {
public:
    explicit AnalyticCost(const FitProblem& problem) : problem_(&problem) {
        set_num_residuals(static_cast<int>(problem.residualCount));
        mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.start.size()));
    }

    bool Evaluate(const double* const* parameters,
                  double* residuals,
                  double** jacobians) const override {
        if (!ResidualCall{problem_}(parameters, residuals)) return false;
        if (jacobians == nullptr || jacobians[0] == nullptr) return true;
        const std::size_t n = problem_->start.size();
        const auto rows = static_cast<Eigen::Index>(problem_->residualCount);
        const auto columns = static_cast<Eigen::Index>(n);
        Eigen::MatrixXd j = Eigen::MatrixXd::Constant(rows, columns, kNan);
        if (!problem_->jacobian(std::span(parameters[0], n), j) || !j.allFinite()) return false;
        using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        Eigen::Map<RowMajor>(jacobians[0], rows, columns) = j;
        return true;
    }

private:
    const FitProblem* problem_;
};

std::unique_ptr<ceres::CostFunction> makeCost(const FitProblem& problem) {
    if (problem.jacobian) return std::make_unique<AnalyticCost>(problem);
    using Numeric = ceres::DynamicNumericDiffCostFunction<ResidualCall, ceres::CENTRAL>;
    auto cost = std::make_unique<Numeric>(new ResidualCall{&problem});
    cost->AddParameterBlock(static_cast<int>(problem.start.size()));
    cost->SetNumResiduals(static_cast<int>(problem.residualCount));
    return cost;
}

FitReport poisoned(const FitProblem& problem) {
    const auto n = static_cast<Eigen::Index>(problem.start.size());
    FitReport report;
    report.params.assign(problem.start.size(), kNan);
    report.covariance = Eigen::MatrixXd::Constant(n, n, kNan);
    report.rms = kNan;
    return report;
}

FitReport failed(FitReport report, FitStatus status, std::string message) {
    report.status = status;
    report.message = std::move(message);
    return report;
}

/// J at the solution.
Eigen::MatrixXd jacobianOf(ceres::Problem& problem, Eigen::Index columns) {
    ceres::CRSMatrix sparse;
    problem.Evaluate({}, nullptr, nullptr, nullptr, &sparse);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(sparse.num_rows, columns);
    for (int row = 0; row < sparse.num_rows; ++row) {
        const auto r = static_cast<std::size_t>(row);
        for (int k = sparse.rows[r]; k < sparse.rows[r + 1]; ++k) {
            const auto entry = static_cast<std::size_t>(k);
            dense(row, sparse.cols[entry]) = sparse.values[entry];
        }
    }
    return dense;
}

/// (J^T J)^-1 by singular values, after each column is scaled to length 1 so that the units of the
/// parameters do not matter. False where J has no full rank. (Ceres' own estimate says so on
/// stderr as well, which belongs to the log.)
bool fillCovariance(const Eigen::MatrixXd& jacobian, Eigen::MatrixXd& covariance) {
    constexpr double kSmallestRatio = 1e-7;  // differences carry about 1e-9 of noise
    const Eigen::VectorXd lengths = jacobian.colwise().norm().transpose();
    if (!lengths.allFinite() || lengths.minCoeff() <= 0) return false;
    const Eigen::VectorXd scale = lengths.cwiseInverse();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian * scale.asDiagonal(), Eigen::ComputeThinV);
    const Eigen::VectorXd& s = svd.singularValues();
    if (s.minCoeff() < kSmallestRatio * s.maxCoeff()) return false;
    const Eigen::MatrixXd root = scale.asDiagonal() * svd.matrixV() * s.cwiseInverse().asDiagonal();
    covariance = root * root.transpose();
    return covariance.allFinite();
}

}  // namespace

std::string_view name(FitStatus status) {
    switch (status) {
        case FitStatus::Converged: return "converged";
        case FitStatus::Singular: return "singular";
        case FitStatus::TooFewData: return "too few data";
        case FitStatus::BadStart: return "bad start";
        case FitStatus::NotConverged: return "not converged";
    }
    return "unknown";
}

FitReport fit(const FitProblem& problem) {
    FitReport report = poisoned(problem);
    const std::size_t n = problem.start.size();
    if (n == 0 || problem.residualCount < n) {
        return failed(std::move(report),
                      FitStatus::TooFewData,
                      std::to_string(problem.residualCount) + " residuals for " +
                          std::to_string(n) + " parameters");
    }
    std::vector<double> params = problem.start;
    std::vector<double> residuals(problem.residualCount, kNan);
    const double* const start = params.data();
    if (!ResidualCall{&problem}(&start, residuals.data())) {
        return failed(std::move(report), FitStatus::BadStart, "no finite residuals at the start");
    }

    ceres::Problem ceresProblem;
    ceresProblem.AddResidualBlock(makeCost(problem).release(), nullptr, params.data());
    for (std::size_t i = 0; i < n; ++i) {
        const int k = static_cast<int>(i);
        if (!problem.lower.empty())
            ceresProblem.SetParameterLowerBound(params.data(), k, problem.lower[i]);
        if (!problem.upper.empty())
            ceresProblem.SetParameterUpperBound(params.data(), k, problem.upper[i]);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.num_threads = 1;
    options.max_num_iterations = problem.maxIterations;
    options.function_tolerance = 1e-14;
    options.gradient_tolerance = 1e-14;
    options.parameter_tolerance = 1e-12;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &ceresProblem, &summary);

    report.iterations = static_cast<int>(summary.iterations.size());
    report.message = summary.message;
    const bool usable =
        summary.IsSolutionUsable() && std::isfinite(summary.final_cost) &&
        std::all_of(params.begin(), params.end(), [](double v) { return std::isfinite(v); });
    if (!usable) return failed(std::move(report), FitStatus::NotConverged, summary.message);
    report.params = params;
    report.rms = std::sqrt(2 * summary.final_cost / static_cast<double>(problem.residualCount));
    if (summary.termination_type != ceres::CONVERGENCE) {
        return failed(std::move(report), FitStatus::NotConverged, summary.message);
    }
    if (!fillCovariance(jacobianOf(ceresProblem, static_cast<Eigen::Index>(n)),
                        report.covariance)) {
        report.covariance.setConstant(kNan);
        return failed(std::move(report),
                      FitStatus::Singular,
                      "the data leave a combination of the parameters free");
    }
    report.status = FitStatus::Converged;
    return report;
}

}  // namespace gonio::proc
