#pragma once
// --estimator: how a file is asked between and beyond what was measured.
//   auto        what predicts the sample best (proc/estimate/sample_estimator.h); of scattered
//               values kriging (scattered_estimator.h)
//   none        the look-up alone: no answer beyond the angles of the file
//   shepard, axis-linear, grid-linear   the thesis's (proc/estimate/seed004.h), and beyond the
//               angles its constant extrapolation, or another one: grid-linear:bezier
//   and the names of methodNames(), one method of auto's without the choice.
// A sample of several rotations has an estimator for each (rotations_estimator.h); the thesis's
// take it as isotropic, and are refused.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "daemon/material.h"
#include "proc/core/effort.h"
#include "proc/estimate/sample_estimator.h"

namespace gonio::daemon {

struct EstimatorChoice {
    std::string name = "auto";
    Effort effort = Effort::Standard;
    std::filesystem::path prior;  ///< a library of `prior build`; empty: the standard one
};

struct Estimated {
    std::shared_ptr<const Scatterer> scatterer;  ///< shared with what it was made over
    Material material;  ///< the file's own; empty kind for scattered values
    /// Of the scatterer, where it chooses; else null.
    const proc::SampleEstimator* sample = nullptr;
    std::vector<Radians> scattered{};  ///< incidences of scattered values, at most 12

    /// That the file knows: the LEDs' where it is a formula.
    [[nodiscard]] std::vector<Radians> incidences() const {
        return scattered.empty() ? material.incidences() : scattered;
    }
    /// Of the sample on the stage, ascending, each once; 0 where the file knows none.
    [[nodiscard]] std::vector<Radians> rotations() const;
};

/// Whether F is a file that lists directions, as a .csv does: `auto` is then the only estimator.
[[nodiscard]] bool holdsScattered(const std::string& f);

/// A measured sample, a table or a formula, ready to answer; errors as openEstimated, without its
/// name. What holds all directions, as MERL tables and formulas do, is its own estimator: any but
/// auto and none is a Usage error.
[[nodiscard]] Result<Estimated> estimated(Material material, const EstimatorChoice& choice);
/// Likewise a file that was read; of scattered values the estimator is auto.
[[nodiscard]] Result<Estimated> estimated(proc::BrdfFile file, const EstimatorChoice& choice);

/// F, ready to answer.
[[nodiscard]] Result<Estimated> openEstimated(const std::string& f,
                                              const std::filesystem::path& store,
                                              const EstimatorChoice& choice,
                                              proc::EvalPath path = {});

}  // namespace gonio::daemon
