#pragma once
// What a fit of a family to rows of data minimises, as sums (proc/solve/normal_fit.h). Parameters
// are fitted as numbers q: the value itself, or its logarithm; shared ones first, then each
// per-band one for the bands in turn.
//
// The values of one incidence and band share an error of standard uncertainty uState times f. Its
// part in the covariance of the data is s s^T, s = uState m0 / u, m0 the model of a fit without it:
// with the measured f in its place, whose noise it would share, a fit comes out too small. By the
// rank-one inverse
//   r^T (1 + s s^T)^-1 r = r.r - (r.s)^2 / (1 + s.s),
// likewise for J^T r and J^T J: nothing more is fitted, and no offset of an LED counts as misfit
// beyond its uncertainty. Fits that are not weighted by uncertainty leave this out of the sums and
// have it in their covariance.

#include <cstdint>
#include <span>
#include <vector>

#include "proc/fit/model_fit.h"
#include "proc/solve/normal_fit.h"

namespace gonio::proc {

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

    [[nodiscard]] std::size_t residualCount(std::span<const std::uint32_t> rows) const;
    [[nodiscard]] std::optional<NormalSums> sums(std::span<const double> q,
                                                 std::span<const std::uint32_t> rows,
                                                 Wanted wanted) const;
    /// Whether the sums are those of the data's own covariance, so that (J^T W J)^-1 is that of the
    /// parameters.
    [[nodiscard]] bool byCovariance() const {
        return options_.weights.uncertainty && !options_.weights.cosine;
    }
    /// From now on with the errors that incidences and bands share, about this model; on rows of
    /// all data.
    void shareErrors(const FamilyPoint& point);
    /// r^T C^-1 r of f against its uncertainties, whatever the weights.
    [[nodiscard]] double chiSquare(const FamilyPoint& point,
                                   std::span<const std::uint32_t> rows) const;
    /// sum W^2 j j^T, and per band sum W j u_systematic / u: for covariances at the solution.
    struct Spread {
        Eigen::MatrixXd squared;
        Eigen::MatrixXd plain;       ///< J^T W^2 J, without shared errors
        Eigen::MatrixXd systematic;  ///< one column per band
    };
    [[nodiscard]] Spread spread(std::span<const double> q,
                                std::span<const std::uint32_t> rows) const;

    /// The best per-band parameters within their bounds at given shared ones (`q` holds both): the
    /// minimum of the quadratic that the cost is in them. Returns the cost; NaN where there is
    /// none.
    double solvePerBand(std::vector<double>& q, std::span<const std::uint32_t> rows) const;

private:
    struct Weight {
        double loss;    ///< rho(s)
        double factor;  ///< rho'(s)
    };
    [[nodiscard]] Weight robust(double s) const;
    [[nodiscard]] double stateOf(const FitRow& row, std::size_t band) const {
        if (state_.empty()) return 0;
        return state_[static_cast<std::size_t>(&row - data_->rows.data())][band];
    }
    /// What the values of an incidence and a band have in common.
    struct Shared {
        double rs = 0;  ///< r.s
        double ss = 0;  ///< s.s
        std::array<double, kMostLocal> js{};
    };
    /// What the residual of a row and band is divided by, the root of its weight included.
    [[nodiscard]] double scaleOf(const FitRow& row, std::size_t band) const;
    /// Calls visit(row, band, slopes, residual, scale) for each value of the rows.
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
    std::vector<std::array<double, 3>> state_;  ///< uState m0 by row; empty: left out
    std::array<double, 3> size_{1, 1, 1};       ///< rms of f, for fits without uncertainties
};

}  // namespace gonio::proc
