#pragma once
// The check of how a sample lay (proc/quality/tilt.h), and what follows from it: a tilt that is
// sure and does harm is corrected, any other goes into the uncertainties; where a lobe does not
// tell its tilt, or there is none, what samples are seated to does. The verdicts `tilt` and
// `waviness` stand in the sample's information (proc/quality/verdict.h).

#include <optional>

#include "daemon/quality_limits.h"
#include "proc/quality/tilt.h"
#include "proc/table/sample_set.h"

namespace gonio::daemon {

/// Whether its tilt is sure, and does harm.
[[nodiscard]] bool worthCorrecting(const std::optional<proc::TiltEstimate>& estimate,
                                   const PoseLimits& limits = {});

/// `estimate` is of this sample; empty: none.
[[nodiscard]] proc::SampleSet referredToItsNormal(proc::SampleSet sample,
                                                  const std::optional<proc::TiltEstimate>& estimate,
                                                  const PoseLimits& limits = {});
/// Estimates first; `uAngle`: standard uncertainty of the lens map's directions, per axis.
[[nodiscard]] proc::SampleSet referredToItsNormal(proc::SampleSet sample,
                                                  Radians uAngle,
                                                  const PoseLimits& limits = {});

}  // namespace gonio::daemon
