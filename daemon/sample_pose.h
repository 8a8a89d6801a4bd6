#pragma once
// The check of how a sample lay (proc/quality/tilt.h), and what follows from it: a tilt that is
// sure and does harm is corrected, any other goes into the uncertainties; where a lobe does not
// tell its tilt, what samples are seated to does. The verdicts `tilt` and `waviness` stand in the
// sample's information (proc/quality/verdict.h).

#include <optional>

#include "proc/quality/tilt.h"
#include "proc/table/sample_set.h"

namespace gonio::daemon {

struct PoseLimits {
    Radians corrected = 0.05_deg;  ///< and three standard uncertainties: smaller ones are let be
    Radians warned = 1_deg;
    Radians refused = 5_deg;  ///< the model of a tilt holds no longer
    Radians wavy = 0.2_deg;   ///< root mean square between the LEDs' normals
    double matt = 0.5;  ///< alpha: a wider lobe shows its tilt badly, and hardly suffers from it
};

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
