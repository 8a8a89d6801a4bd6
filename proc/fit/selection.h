#pragma once
// Which of several families describes data. All are fitted; a family is rejected where the noise
// cannot explain by how much it fits worse than the best: (chi-square difference) / s^2 beyond what
// chi-square with max(1, difference in parameters) degrees of freedom exceeds once in 1000, s^2
// being the best family's chi-square per degree of freedom, at least 1. Noise is not all that is
// wrong with data: a family stays where it differs from the best by less than what the values have
// as a common systematic uncertainty, root mean square in each region of each incidence and band.
// (Common errors have shapes, such as that of a tilt, by which a richer family may seem better.) Of
// those that are left the one with the fewest parameters is named, of equals the one with the least
// chi-square.
//
// Where even the best misfits by more than the gate (chi-square per degree of freedom above 1.15,
// and beyond five standard deviations of it), and in some region by more than the common systematic
// uncertainty, no family fits: nothing is named, and the evidence says by how much and where.

#include <functional>

#include "proc/fit/model_fit.h"

namespace gonio::proc {

struct RankedFit {
    ModelFit fit;
    std::optional<double> nanoseconds;  ///< per evaluation, where the caller measured it
    bool pareto = false;     ///< no other is at least as good in error, parameters and time
    bool rejected = true;    ///< against the best
    double probability = 0;  ///< that noise makes it as much worse than the best as it is
    /// Largest distance from the best in units of the common systematic uncertainty, both as root
    /// mean squares over a region of an incidence and band; infinite where there is no such
    /// uncertainty.
    double apart = 0;

    /// What is ranked by: the held-out error, infinite where there is none; where no fit has one,
    /// the rms of what is left.
    [[nodiscard]] double error() const;
    double restRms = 0;   ///< of f - model over that of f, all rows
    bool byRest = false;  ///< no fit has a held-out error
};

/// Where a fit misses most: a part of one incidence.
struct Misfit {
    Radians incidence;
    std::string region;    ///< "toward the light", "about the mirror direction", ...
    double chiSquare = 0;  ///< mean square of (f - model) / u there
    double meanRatio = 0;  ///< sum of f over sum of the model; not finite where that is 0
    std::size_t values = 0;
};

struct Selection {
    std::vector<RankedFit> ranked;      ///< by error, the smallest first; failures last
    std::optional<std::size_t> chosen;  ///< index into `ranked`
    std::optional<std::size_t> best;    ///< by chi-square
    double gate = 1.15;                 ///< of chi-square per degree of freedom
    /// Of the best fit beyond noise, in units of the common systematic uncertainty, as
    /// RankedFit::apart; infinite where there is none.
    double misfit = 0;
    std::vector<Misfit> worst;  ///< regions of the best fit, the worst first
    std::string verdict;        ///< one sentence with the evidence
};

struct SelectionOptions {
    ModelFitOptions fit;
    /// Nanoseconds per evaluation of a spec; empty: not measured.
    std::function<std::optional<double>(const std::string& spec)> nanoseconds;
};

[[nodiscard]] Selection selectModel(const std::vector<const Family*>& families,
                                    const BrdfData& data,
                                    const SelectionOptions& options = {});

/// The choice among fits that were already made.
[[nodiscard]] Selection selectAmong(std::vector<ModelFit> fits, const BrdfData& data);

}  // namespace gonio::proc
