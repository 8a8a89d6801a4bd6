#pragma once
// The statistical prior (proc/fit/prior.h) as a method: f from the posterior of each band, with its
// deviation as the random uncertainty; f = (exp(y) - 1e-5 / sr) / (cos(theta_i) cos(theta_o)).
//
// Systematic errors that are common to all values move all answers alike: their uncertainty is, by
// band, the values' median relative one.

#include <array>
#include <memory>
#include <optional>

#include "proc/estimate/incidence_method.h"
#include "proc/fit/prior.h"

namespace gonio::proc {

/// The posteriors of one sample, from all of its incidences and from all but one.
class SamplePrior {
public:
    /// `basis` is shared by all samples of a run.
    SamplePrior(std::shared_ptr<const PriorBasis> basis, const BrdfData& data);

    /// By band; empty where the band was not measured.
    [[nodiscard]] const std::array<std::optional<PriorGate>, 3>& gates() const { return gates_; }
    /// In every band that was measured.
    [[nodiscard]] bool passes() const;
    [[nodiscard]] std::unique_ptr<const IncidenceMethod> method(
        std::optional<std::size_t> without = {}) const;

private:
    std::shared_ptr<const PriorBasis> basis_;  ///< outlives the sample in its methods
    std::array<std::optional<PriorEvidence>, 3> evidence_;
    std::array<std::optional<PriorGate>, 3> gates_;
    std::array<double, 3> commonRelative_{};
};

}  // namespace gonio::proc
