#pragma once
// A family fitted to data: the parameters that minimise sum w rho(((f - model) / u)^2) within their
// bounds, and all that says how far to trust them. A band that was not measured has no parameters:
// they stand in the list, held at their lower bounds, and count nowhere.
//
// Start: at each point of a grid of the shared parameters the per-band ones follow from a linear
// problem; the best points are refined on some rows, the best of these on all rows.
//
// Reported: the random covariance of the parameters that no bound holds (NaN in the rows of the
// others): (J^T C^-1 J)^-1 where the fit is by the data's covariance C, else H^-1 N H^-1 with the
// curvature H = sum w (rho' + 2 r^2 rho'') j j^T and N = sum (w rho')^2 j j^T, times r^2 each under
// a robust loss (White's), plus what values share; scaled by chi-square per degree of freedom where
// the uncertainties of the data were assumed and the loss is plain. The change of the parameters
// when all values of a band shift by their systematic uncertainty together, bands independent, as
// the fit without shared errors would take it.
// Warnings where the data do not tell parameters apart. Chi-square is always that of f against u,
// whatever the weights of the fit; where u was assumed, the information criteria are those of an
// unknown variance, N ln(chi-square / N) in place of chi-square.
//
// No more values than parameters: TooFewData, all NaN. The same data give the same bits.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "proc/fit/brdf_data.h"
#include "proc/fit/family.h"
#include "proc/solve/least_squares.h"

namespace gonio::proc {

/// w of a value.
struct FitWeights {
    bool uncertainty = true;  ///< by 1 / u_random^2; else by 1 / the band's mean square of f
    bool cosine = false;      ///< by cos(theta_o): for the energy, not for the likelihood
};

/// rho(s), s = ((f - model) / u_random)^2.
enum class RobustLoss {
    None,
    Huber,  ///< s to scale^2, then 2 scale sqrt(s) - scale^2
    Cauchy  ///< scale^2 log(1 + s / scale^2)
};

struct ModelFitOptions {
    FitWeights weights;
    RobustLoss loss = RobustLoss::None;
    double lossScale = 3;  ///< in standard uncertainties
    std::size_t startRows = 400;
    std::size_t heldOutRows = 2000;  ///< rows of a refit without one incidence; 0: none of these
    int maxIterations = 100;
    double tolerance = 1e-12;          ///< relative change of the cost that ends the search
    std::optional<FamilyPoint> start;  ///< refined instead of the grid's points
};

struct FittedParameter {
    std::string name;  ///< "ggx.alpha", "lambert.albedo"
    std::string unit;
    std::optional<Band> band;  ///< of a per-band parameter of a fit to three bands
    bool measured = true;      ///< false: of a band without values
    double value = 0;          ///< NaN where not measured
    double uRandom = 0;        ///< NaN where it is held or not determined
    double uSystematic = 0;
    double lower = 0;
    double upper = 0;
    bool atLower = false;
    bool atUpper = false;
};

/// A refit without one incidence, held against that incidence.
struct HeldOut {
    Radians incidence;
    /// Root mean square of f - model over that of f, weighted by solid angle.
    double rms = 0;
    /// Likewise with each weighted by cos(theta_o), too: error of the reflected energy.
    double energyRms = 0;
    /// Mean square of (f - model) / u, u as BrdfData::uOf.
    double chiSquare = 0;
};

struct ModelFit {
    const Family* family = nullptr;
    FitStatus status = FitStatus::NotConverged;
    std::string message;
    int iterations = 0;  ///< of the fit to all rows
    int starts = 0;      ///< refined
    FamilyPoint point;
    std::vector<FittedParameter> parameters;
    Eigen::MatrixXd covariance;   ///< random; NaN where held or not determined
    Eigen::MatrixXd correlation;  ///< 1 on the diagonal; NaN likewise
    double condition = 0;         ///< of the scaled normal matrix
    std::vector<std::string> warnings;
    double chiSquare = 0;
    std::size_t values = 0;
    bool uKnown = true;
    std::vector<HeldOut> heldOut;
    bool allHeldOut = false;  ///< each incidence could be predicted from the others
    std::string spec;

    /// Converged, or all but a free combination of parameters.
    [[nodiscard]] bool usable() const {
        return status == FitStatus::Converged || status == FitStatus::Singular;
    }
    /// Of bands that were measured.
    [[nodiscard]] std::size_t parameterCount() const;
    [[nodiscard]] double degreesOfFreedom() const {
        return static_cast<double>(values) - static_cast<double>(parameterCount());
    }
    [[nodiscard]] double chiSquarePerDof() const { return chiSquare / degreesOfFreedom(); }
    /// chi-square + 2 k, and + k ln N; N ln(chi-square / N) for chi-square where u was assumed.
    [[nodiscard]] double aic() const;
    [[nodiscard]] double bic() const;
    /// Root mean square over the incidences; empty where one could not be predicted.
    [[nodiscard]] std::optional<double> heldOutRms() const;
    [[nodiscard]] std::optional<double> heldOutEnergyRms() const;
};

[[nodiscard]] ModelFit fitModel(const Family& family,
                                const BrdfData& data,
                                const ModelFitOptions& options = {});

/// (f - model) / u of each row and band, u of all but what is common (BrdfData::uOf); NaN where
/// there is no value.
[[nodiscard]] std::vector<std::array<double, 3>> normalisedResiduals(const ModelFit& fit,
                                                                     const BrdfData& data);

}  // namespace gonio::proc
