#pragma once
// The light that a sample sends into the measured field, as a share of what falls on it:
//     rho = sum over cells of f cos(theta_o) Omega,
// a lower bound of the albedo, which no sample that is passive and does not fluoresce can have
// above 1. Cells are independent in u_random and of one mind in u_systematic, which therefore adds
// up linearly.

#include <optional>

#include "proc/calibrate/cell_samples.h"
#include "proc/core/measured.h"
#include "proc/quality/limits.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

/// Of one state over CellGrid; empty when no cell is present.
[[nodiscard]] std::optional<Measured<double>> reflectedFraction(const CellSamples& cells);

/// `energy`: refused when any state sends back more than 1 by three standard uncertainties. Its
/// figure is that of the state that is furthest above 1, or nearest to it, counted in these.
[[nodiscard]] Verdict energyVerdict(const SampleSet& sample, const QualityLimits& limits = {});

}  // namespace gonio::proc
