#pragma once
// Which of several families describes data. All are fitted; a family is rejected where the noise
// cannot explain by how much it fits worse than the best: (chi-square difference) / s^2 beyond what
// chi-square with max(1, difference in parameters) degrees of freedom exceeds once in 1000, s^2
// being the best family's chi-square per degree of freedom, at least 1. Where even the best misfits
// beyond three standard deviations, a quarter of that excess is not held against a rival: it comes
// from errors that the uncertainties do not tell. Of those that are left the
// one with the fewest parameters is named, of equals the one with the least chi-square.
//
// Where even the best misfits by more than the gate (chi-square per degree of freedom above 1.15,
// and beyond five standard deviations of it), no family fits: nothing is named, and the evidence
// says by how much and where.

#include <functional>

#include "proc/fit/model_fit.h"

namespace gonio::proc {

struct RankedFit {
    ModelFit fit;
    std::optional<double> nanoseconds;  ///< per evaluation, where the caller measured it
    bool pareto = false;     ///< no other is at least as good in error, parameters and time
    bool rejected = true;    ///< by the noise, against the best
    double probability = 0;  ///< that noise makes it as much worse than the best as it is

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
    std::vector<Misfit> worst;          ///< regions of the best fit, the worst first
    std::string verdict;                ///< one sentence with the evidence
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
