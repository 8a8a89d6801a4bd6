#pragma once
// A statistical prior of what surfaces look like, as a Gaussian in y = ln(f cos(theta_i)
// cos(theta_o) + 1e-5), after [Nielsen2015]: fewer numbers than directions say what a material is,
// and measured values say which.
//
// Basis. The functions of the library's materials are evaluated on a grid of half and difference
// angles over the whole hemisphere of light and view, and some of them are picked, each the one
// that the others picked so far describe worst (pivoted Gram-Schmidt). y of any material is taken
// as a combination of those: being models, they answer at every pair, and no table is
// interpolated. What all materials of the library have as coefficients gives the Gaussian's mean
// and covariance; what the combinations leave over on the grid is a variance by direction.
//
// Posterior. Measured y with its noise and that variance gives coefficients by Gaussian
// conditioning; an answer has a standard deviation. Whether the material is of the kind that the
// library knows is asked of what was measured (PriorGate): by reduced chi-square about the
// posterior, and by how well each incidence is predicted from the others. Where not, the posterior
// must not be used: it is overconfident then.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "proc/core/direction.h"
#include "proc/core/result.h"
#include "proc/fit/brdf_data.h"
#include "proc/fit/prior_library.h"
#include "proc/models/analytic.h"

namespace gonio::proc {

inline constexpr double kPriorFloor = 1e-5;  ///< 1/sr, beside f cos(theta_i) cos(theta_o)

class PriorBasis {
public:
    /// Of the standard prior; its gate and its coverage were measured with these.
    static constexpr std::size_t kFunctions = 200;

    /// A Usage error for a spec that is no model. Fewer functions where the library has fewer
    /// materials that differ.
    [[nodiscard]] static Result<PriorBasis> over(const PriorLibrary& library,
                                                 std::size_t functions = kFunctions);

    [[nodiscard]] std::size_t size() const { return picked_.size(); }
    /// The orthonormal functions at a pair above the horizon.
    [[nodiscard]] Eigen::VectorXd at(const LightView& pair) const;
    /// The same of the data's rows, one column each, f being the mean over a row's nodes.
    [[nodiscard]] Eigen::MatrixXd at(const BrdfData& data) const;
    /// Variance of what the functions leave over, near the pair.
    [[nodiscard]] double restVariance(const Pair<double>& pair) const;

    [[nodiscard]] const Eigen::VectorXd& mean() const { return mean_; }
    [[nodiscard]] const Eigen::MatrixXd& covariance() const { return covariance_; }

private:
    PriorBasis() = default;

    std::vector<std::shared_ptr<const AnalyticModel>> picked_;  ///< shared by copies of the basis
    Eigen::MatrixXd triangle_;                                  ///< picked = orthonormal * triangle
    Eigen::VectorXd mean_;                                      ///< of the coefficients
    Eigen::MatrixXd covariance_;
    std::vector<double> rest_;  ///< by grid place; NaN below the horizon
};

/// What measured values made of the prior, in one band.
class PriorPosterior {
public:
    struct Value {
        double y = 0;
        double deviation = 0;  ///< standard, of y
    };

    PriorPosterior(Eigen::VectorXd mean, Eigen::MatrixXd inverseFactor)
        : mean_(std::move(mean)), inverseFactor_(std::move(inverseFactor)) {}

    [[nodiscard]] Value at(const Eigen::VectorXd& functions, double restVariance) const;
    [[nodiscard]] const Eigen::VectorXd& mean() const { return mean_; }
    [[nodiscard]] const Eigen::MatrixXd& inverseFactor() const { return inverseFactor_; }

private:
    Eigen::VectorXd mean_;           ///< of the coefficients
    Eigen::MatrixXd inverseFactor_;  ///< L^-1 of their precision L L^T
};

/// A band's measured values as the prior sees them, by incidence.
class PriorEvidence {
public:
    /// `functions` as the basis gives them for the data. Values of more than 0.3 relative
    /// uncertainty are left out: their logarithm is not Gaussian.
    PriorEvidence(const PriorBasis& basis,
                  const BrdfData& data,
                  const Eigen::MatrixXd& functions,
                  std::size_t band);

    [[nodiscard]] bool empty() const;
    /// From all incidences, or from all but one.
    [[nodiscard]] PriorPosterior posterior(std::optional<std::size_t> without = {}) const;
    /// Of the values about a posterior made from them all, per degree of freedom.
    [[nodiscard]] double chiSquare(const PriorPosterior& posterior) const;
    /// Mean square of the values at one incidence about a posterior made without them, in units of
    /// what it predicts them to scatter by.
    [[nodiscard]] double predictedChiSquare(const PriorPosterior& without, std::size_t group) const;

private:
    struct Group {
        Eigen::MatrixXd functions;  ///< columns: over the deviation of a value
        Eigen::VectorXd y;          ///< likewise
        Eigen::MatrixXd precision;  ///< what the group adds to it, lower triangle
        Eigen::VectorXd pull;
    };

    const PriorBasis* basis_;
    Eigen::MatrixXd priorPrecision_;
    std::vector<Group> groups_;
};

/// What says whether a material is of the library's kind.
struct PriorGate {
    static constexpr double kMost = 1.15;             ///< chi-square
    static constexpr double kMostPredicted = 2;       ///< between other incidences
    static constexpr double kMostPredictedAtEnd = 4;  ///< the first and the last

    double chiSquare = 0;
    std::vector<double> predicted;  ///< by incidence, each from the others

    [[nodiscard]] bool passes() const;
};
[[nodiscard]] PriorGate priorGate(const PriorEvidence& evidence, std::size_t incidences);

}  // namespace gonio::proc
