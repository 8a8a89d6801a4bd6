#pragma once
// Where each verdict draws its line. Why there, and how often a good sample crosses it:
// docs/quality.md.

#include "proc/core/units.h"
#include "proc/quality/verdict.h"

namespace gonio::proc {

struct QualityLimits {
    double sure = 5;  ///< standard uncertainties beyond which a change is more than chance

    /// Median relative difference of reciprocal pairs.
    Limits reciprocity{.warned = 0.05, .refused = 0.15};
    double reciprocityChiSquare = 4;  ///< per pair, below which the difference is explained

    /// Median relative difference between the sides of the plane of incidence, and between
    /// rotations; chi-square per degree of freedom, below which it is chance.
    double planeSymmetry = 0.02, isotropy = 0.02;
    double symmetryChiSquare = 4;
    double repeatOutliers = 1e-4;  ///< share of repeated values beyond five standard uncertainties

    double energySure = 3;  ///< standard uncertainties above an albedo of 1

    /// Share of the field's solid angle.
    Limits saturation{.warned = 0, .refused = 0.05};

    /// Light that leaks in, over the light that f = 1e-3 sends to the camera.
    Limits ambient{.warned = 0.001, .refused = 1};
    double ambientF = 1e-3;

    /// Relative change from the first bracket to the same one repeated last.
    double softness = 0.01, drift = 0.015;

    double translucencySure = 3;
    double translucency = 0.005;  ///< of diffuse reflectance, black to white backing
};

}  // namespace gonio::proc
