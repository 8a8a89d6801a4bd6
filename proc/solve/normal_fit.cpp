#include "proc/solve/normal_fit.h"

#include <ceres/ceres.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargestCondition = 1e12;  // of the matrix; 1e6 of J

using Index = Eigen::Index;

/// The matrix with its columns scaled to length 1: S M S = V L V^T, S diagonal.
struct Scaled {
    Eigen::VectorXd scale;
    Eigen::VectorXd values;
    Eigen::MatrixXd vectors;

    explicit Scaled(const Eigen::MatrixXd& matrix)
        : scale(matrix.diagonal().unaryExpr(
              [](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; })) {
        const Eigen::MatrixXd even = scale.asDiagonal() * matrix * scale.asDiagonal();
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(even);
        values = solver.eigenvalues();
        vectors = solver.eigenvectors();
    }
    [[nodiscard]] double condition() const {
        const double smallest = values.minCoeff();
        return smallest > 0 ? values.maxCoeff() / smallest
                            : std::numeric_limits<double>::infinity();
    }
};

/// The free parameters of a problem; the others stay as they are.
class FreePart {
public:
    FreePart(const NormalProblem& problem, std::vector<double> all, const std::vector<bool>& held)
        : problem_(&problem), all_(std::move(all)) {
        for (std::size_t i = 0; i < held.size(); ++i) {
            if (!held[i]) places_.push_back(i);
        }
    }

    [[nodiscard]] std::size_t count() const { return places_.size(); }
    [[nodiscard]] const std::vector<std::size_t>& places() const { return places_; }

    [[nodiscard]] std::vector<double> withFree(const double* values) const {
        std::vector<double> p = all_;
        for (std::size_t i = 0; i < places_.size(); ++i) p[places_[i]] = values[i];
        return p;
    }
    [[nodiscard]] std::optional<NormalSums> sums(const double* values, Wanted wanted) const {
        std::optional<NormalSums> sums = problem_->sums(withFree(values), wanted);
        if (!sums || !std::isfinite(sums->cost)) return std::nullopt;
        if (wanted == Wanted::Derivatives && !sums->finite()) return std::nullopt;
        return sums;
    }
    [[nodiscard]] Eigen::VectorXd ofGradient(const NormalSums& sums) const {
        Eigen::VectorXd part(static_cast<Index>(count()));
        for (std::size_t i = 0; i < count(); ++i) {
            part(static_cast<Index>(i)) = sums.gradient(static_cast<Index>(places_[i]));
        }
        return part;
    }
    [[nodiscard]] Eigen::MatrixXd ofMatrix(const NormalSums& sums) const {
        const auto n = static_cast<Index>(count());
        Eigen::MatrixXd part(n, n);
        for (Index i = 0; i < n; ++i) {
            for (Index k = 0; k < n; ++k) {
                part(i, k) = sums.matrix(static_cast<Index>(places_[static_cast<std::size_t>(i)]),
                                         static_cast<Index>(places_[static_cast<std::size_t>(k)]));
            }
        }
        return part;
    }

private:
    const NormalProblem* problem_;
    std::vector<double> all_;
    std::vector<std::size_t> places_;
};

/// n + 1 residuals with J = sqrt(L) V^T S^-1, r = (V^T S g) / sqrt(L), and what is left of the cost
/// in the last, whose derivatives are 0: J^T J and J^T r are those of all rows.
class CompressedCost : public ceres::CostFunction {
public:
    explicit CompressedCost(const FreePart& part) : part_(&part) {
        set_num_residuals(static_cast<int>(part.count()) + 1);
        mutable_parameter_block_sizes()->push_back(static_cast<int>(part.count()));
    }

    bool Evaluate(const double* const* parameters,
                  double* residuals,
                  double** jacobians) const override {
        const bool derivatives = jacobians != nullptr && jacobians[0] != nullptr;
        const auto sums =
            part_->sums(parameters[0], derivatives ? Wanted::Derivatives : Wanted::Cost);
        if (!sums) return false;
        const auto n = static_cast<Index>(part_->count());
        Eigen::Map<Eigen::VectorXd> r(residuals, n + 1);
        r.setZero();
        r(n) = std::sqrt(sums->cost);
        if (!derivatives) return true;
        using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        Eigen::Map<RowMajor> j(jacobians[0], n + 1, n);
        j.setZero();
        const Eigen::MatrixXd matrix = part_->ofMatrix(*sums);
        const Scaled scaled(matrix);
        const Eigen::VectorXd along =
            scaled.vectors.transpose() * (scaled.scale.asDiagonal() * part_->ofGradient(*sums));
        const double least = 1e-15 * std::max(scaled.values.maxCoeff(), 0.0);
        for (Index i = 0; i < n; ++i) {
            if (!(scaled.values(i) > least)) continue;
            const double root = std::sqrt(scaled.values(i));
            r(i) = along(i) / root;
            for (Index k = 0; k < n; ++k) {
                if (scaled.scale(k) > 0) j(i, k) = root * scaled.vectors(k, i) / scaled.scale(k);
            }
        }
        r(n) = std::sqrt(std::max(0.0, sums->cost - r.head(n).squaredNorm()));
        return true;
    }

private:
    const FreePart* part_;
};

ceres::Solver::Options optionsOf(const NormalProblem& problem) {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.num_threads = 1;
    options.max_num_iterations = problem.maxIterations;
    options.function_tolerance = problem.tolerance;
    options.gradient_tolerance = 1e-14;
    options.parameter_tolerance = 1e-9;
    options.logging_type = ceres::SILENT;
    return options;
}

struct Solved {
    std::vector<double> params;
    ceres::TerminationType how;
    bool usable;
    int iterations;
    std::string message;
};

Solved solve(const NormalProblem& problem, const FreePart& part, std::vector<double> values) {
    ceres::Problem ceresProblem;
    ceresProblem.AddResidualBlock(new CompressedCost(part), nullptr, values.data());  // takes it
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t at = part.places()[i];
        ceresProblem.SetParameterLowerBound(values.data(), static_cast<int>(i), problem.lower[at]);
        ceresProblem.SetParameterUpperBound(values.data(), static_cast<int>(i), problem.upper[at]);
    }
    ceres::Solver::Summary summary;
    ceres::Solve(optionsOf(problem), &ceresProblem, &summary);
    const bool finite =
        std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    return {.params = part.withFree(values.data()),
            .how = summary.termination_type,
            .usable = summary.IsSolutionUsable() && finite && std::isfinite(summary.final_cost),
            .iterations = static_cast<int>(summary.iterations.size()),
            .message = summary.message};
}

/// On a bound, to rounding, and the cost would fall beyond it.
std::vector<bool> pushedOut(const NormalProblem& problem, const NormalFit& fit) {
    std::vector<bool> held(fit.params.size(), false);
    for (std::size_t i = 0; i < held.size(); ++i) {
        const double width = problem.upper[i] - problem.lower[i];
        const double near = std::isfinite(width) ? 1e-9 * width : 1e-12;
        const double slope = fit.sums.gradient(static_cast<Index>(i));
        held[i] = (fit.params[i] - problem.lower[i] <= near && slope >= 0) ||
                  (problem.upper[i] - fit.params[i] <= near && slope <= 0);
    }
    return held;
}

void fillCovariance(const FreePart& part, NormalFit& fit) {
    if (part.count() == 0) return;
    const Scaled scaled(part.ofMatrix(fit.sums));
    fit.condition = scaled.condition();
    if (!(fit.condition < kLargestCondition) || scaled.scale.minCoeff() <= 0) {
        fit.status = FitStatus::Singular;
        fit.message = "the data leave a combination of the parameters free";
        return;
    }
    const Eigen::MatrixXd root = scaled.scale.asDiagonal() * scaled.vectors *
                                 scaled.values.cwiseSqrt().cwiseInverse().asDiagonal();
    const Eigen::MatrixXd covariance = root * root.transpose();
    for (std::size_t i = 0; i < part.count(); ++i) {
        for (std::size_t k = 0; k < part.count(); ++k) {
            fit.covariance(static_cast<Index>(part.places()[i]),
                           static_cast<Index>(part.places()[k])) =
                covariance(static_cast<Index>(i), static_cast<Index>(k));
        }
    }
}

NormalFit poisoned(const NormalProblem& problem) {
    const auto n = static_cast<Index>(problem.start.size());
    NormalFit fit;
    fit.params.assign(problem.start.size(), kNan);
    fit.atBound.assign(problem.start.size(), false);
    fit.sums = NormalSums::zero(problem.start.size());
    fit.sums.cost = kNan;
    fit.covariance = Eigen::MatrixXd::Constant(n, n, kNan);
    fit.condition = kNan;
    return fit;
}

NormalFit failed(NormalFit fit, FitStatus status, std::string message) {
    fit.status = status;
    fit.message = std::move(message);
    return fit;
}

}  // namespace

NormalSums NormalSums::zero(std::size_t parameters) {
    const auto n = static_cast<Index>(parameters);
    return {.cost = 0, .gradient = Eigen::VectorXd::Zero(n), .matrix = Eigen::MatrixXd::Zero(n, n)};
}

bool NormalSums::finite() const {
    return std::isfinite(cost) && gradient.allFinite() && matrix.allFinite();
}

NormalFit fitNormal(const NormalProblem& problem) {
    NormalFit fit = poisoned(problem);
    const std::size_t n = problem.start.size();
    std::vector<bool> held(n, false);
    for (std::size_t i = 0; i < n; ++i) held[i] = problem.lower[i] == problem.upper[i];
    const auto free = static_cast<std::size_t>(std::count(held.begin(), held.end(), false));
    if (free == 0 || problem.residualCount < free) {
        return failed(std::move(fit),
                      FitStatus::TooFewData,
                      std::to_string(problem.residualCount) + " residuals for " +
                          std::to_string(free) + " parameters");
    }
    std::vector<double> at = problem.start;
    for (std::size_t i = 0; i < n; ++i) {
        at[i] = std::clamp(at[i], problem.lower[i], problem.upper[i]);
    }
    if (!FreePart(problem, at, held).sums(at.data(), Wanted::Derivatives)) {
        return failed(std::move(fit), FitStatus::BadStart, "no finite sums at the start");
    }
    // Each round holds what the last one left pushed against a bound; a bound that no longer pushes
    // lets go. As many rounds as there are parameters are enough in practice.
    ceres::TerminationType how = ceres::CONVERGENCE;
    for (std::size_t round = 0; round <= n; ++round) {
        const FreePart part(problem, at, held);
        if (part.count() > 0) {
            std::vector<double> values;
            for (const std::size_t place : part.places()) values.push_back(at[place]);
            const Solved solved = solve(problem, part, std::move(values));
            fit.iterations += solved.iterations;
            fit.message = solved.message;
            if (!solved.usable) {
                return failed(std::move(fit), FitStatus::NotConverged, solved.message);
            }
            at = solved.params;
            how = solved.how;
        }
        fit.params = at;
        const auto sums =
            FreePart(problem, at, std::vector<bool>(n, false)).sums(at.data(), Wanted::Derivatives);
        if (!sums) return failed(std::move(fit), FitStatus::NotConverged, "no finite sums");
        fit.sums = *sums;
        std::vector<bool> pushed = pushedOut(problem, fit);
        if (pushed == held) break;
        held = std::move(pushed);
    }
    fit.atBound = held;
    if (how != ceres::CONVERGENCE) {
        std::string message = fit.message;
        return failed(std::move(fit), FitStatus::NotConverged, std::move(message));
    }
    fit.status = FitStatus::Converged;
    fillCovariance(FreePart(problem, at, held), fit);
    return fit;
}

}  // namespace gonio::proc
