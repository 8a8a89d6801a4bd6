#pragma once
// What a fit of a family to rows of data minimises, as sums (proc/solve/normal_fit.h):
//   sum w rho(r^2), r = (f - model) / u,
// w the cosine, or u^2 over the band's mean square, or 1. Parameters are fitted as numbers q: the
// value itself, or its logarithm; shared ones first, then each per-band one for the bands in turn.
// A parameter of a band that was not measured is held at its lower bound.
//
// Errors that values share are in the covariance of the data (shared_sums.h) once shareErrors() was
// told a model. Fits with other weights or a robust loss leave them out of the sums and have them
// in their covariance.

#include <cstdint>
#include <span>
#include <vector>

#include "proc/fit/model_fit.h"
#include "proc/fit/shared_sums.h"
#include "proc/solve/normal_fit.h"

namespace gonio::proc {

/// Sums over the values of one band, by the shared parameters and then the band's own.
struct BandSums {
    double cost = 0;
    std::array<double, kMostLocal> gradient{};
    std::array<std::array<double, kMostLocal>, kMostLocal> matrix{};

    void add(const std::array<double, kMostLocal>& j,
             double residual,
             double weight,
             std::size_t n);
};

class FitSums {
public:
    FitSums(const Family& family, const BrdfData& data, const ModelFitOptions& options);

    [[nodiscard]] std::size_t count() const { return count_; }
    /// Position of per-band parameter k of band b.
    [[nodiscard]] std::size_t place(std::size_t k, std::size_t b) const {
        return shared_ + k * bands_ + b;
    }
    [[nodiscard]] const FamilyParameter& parameter(std::size_t place) const;
    [[nodiscard]] std::vector<double> lower() const;
    [[nodiscard]] std::vector<double> upper() const;
    [[nodiscard]] double toValue(std::size_t place, double q) const;
    /// d value / d q.
    [[nodiscard]] double slope(std::size_t place, double q) const;
    [[nodiscard]] FamilyPoint point(std::span<const double> q) const;
    /// The q of a point, within its bounds.
    [[nodiscard]] std::vector<double> numbersOf(const FamilyPoint& point) const;

    [[nodiscard]] std::size_t residualCount(std::span<const std::uint32_t> rows) const;
    [[nodiscard]] std::optional<NormalSums> sums(std::span<const double> q,
                                                 std::span<const std::uint32_t> rows,
                                                 Wanted wanted) const;
    /// Whether the sums are those of the data's own covariance, so that (J^T W J)^-1 is that of the
    /// parameters.
    [[nodiscard]] bool byCovariance() const {
        return options_.weights.uncertainty && !options_.weights.cosine &&
               options_.loss == RobustLoss::None;
    }
    /// What a covariance is multiplied with where u was assumed: the squares of residuals say then
    /// what it is, unless they are in the covariance already.
    [[nodiscard]] double assumedScale(double chiSquarePerDof) const {
        return data_->uKnown || options_.loss != RobustLoss::None ? 1 : chiSquarePerDof;
    }
    /// Of a band that was not measured.
    [[nodiscard]] bool isHeld(std::size_t place) const {
        return place >= shared_ && !measured((place - shared_) % bands_);
    }
    /// Whether the band has any value.
    [[nodiscard]] bool measured(std::size_t band) const { return size_[band] > 0; }
    /// From now on with the errors that values share, about this model; on rows of all data.
    void shareErrors(const FamilyPoint& point);
    /// r^T C^-1 r of f against its uncertainties, whatever the weights.
    [[nodiscard]] double chiSquare(const FamilyPoint& point,
                                   std::span<const std::uint32_t> rows) const;
    /// For covariances at the solution, by q: a change d of the residuals moves the parameters by
    /// curvature^-1 sum w rho2 j d, rho2 = rho' + 2 r^2 rho''.
    struct Spread {
        Eigen::MatrixXd curvature;   ///< sum w rho2 j j^T
        Eigen::MatrixXd noise;       ///< covariance of sum w rho' j r: own and shared errors
        Eigen::MatrixXd systematic;  ///< sum w rho2 j u_systematic / u, one column per band
    };
    [[nodiscard]] Spread spread(std::span<const double> q,
                                std::span<const std::uint32_t> rows) const;

    /// The best per-band parameters within their bounds at given shared ones (`q` holds both): the
    /// minimum of the quadratic that the cost is in them. Returns the cost; NaN where there is
    /// none.
    double solvePerBand(std::vector<double>& q, std::span<const std::uint32_t> rows) const;

private:
    struct Loss {
        double value;  ///< rho(s)
        double slope;  ///< rho'(s)
        double bend;   ///< rho'(s) + 2 s rho''(s)
    };
    [[nodiscard]] Loss robust(double s) const;
    /// w of a row and band.
    [[nodiscard]] double weightOf(const FitRow& row, std::size_t band) const;
    /// m0, the model about which errors are shared; 0 before shareErrors().
    [[nodiscard]] double sharedAbout(std::uint32_t row, std::size_t band) const {
        return model_.empty() ? 0 : model_[row].value[band];
    }
    /// Nothing is in it before shareErrors(), nor where `wanted` is false.
    [[nodiscard]] SharedSums sharedErrors(bool wanted) const {
        return {*data_, !model_.empty() && wanted};
    }
    /// sum w rho(r^2); `asWeighted` false: sum r^2 whatever the weights and the loss.
    [[nodiscard]] double cost(const FamilyPoint& point,
                              std::span<const std::uint32_t> rows,
                              bool asWeighted) const;
    void addToAll(std::span<const double> q,
                  std::size_t band,
                  const BandSums& of,
                  NormalSums& total) const;
    /// Calls visit(index, band, slopes) for each value of the rows.
    template <class Visit>
    void eachValue(const FamilyPoint& point,
                   std::span<const std::uint32_t> rows,
                   Visit&& visit) const;

    const Family* family_;
    const BrdfData* data_;
    ModelFitOptions options_;
    std::size_t shared_;
    std::size_t perBand_;
    std::size_t bands_;
    std::size_t count_;
    std::vector<LedBands> model_;   ///< m0 by row; empty: nothing is shared
    std::array<double, 3> size_{};  ///< rms of f, for fits without uncertainties; 0: no value
};

}  // namespace gonio::proc
