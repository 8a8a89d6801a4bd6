#pragma once
// A tilted sample's f, referred to its own normal. The facet that a flat sample would show at
// (wi, wo), with the half vector h, lies at R h; the rig sees it at
//     wo* = 2 (R h . wi) R h - wi,
// and what was measured there is carried to (wi, wo) by the fitted lobe (tilt.h):
//     f(wi, wo) = [f' / lobe'](wi, wo*) lobe(wi, wo).
// The quotient is smooth, so that it is interpolated between the cells; at the lobe itself the
// distribution of facets is the same on both sides and cancels, whatever its real shape.
//
// Where a cell that is needed is missing, the answer is missing for the same reason; where wo* is
// beyond the field, it is Blocked. The tilt's uncertainty and the waves go into u_systematic,
// corrected or not, by what they do to the lobe and to cos(theta_o), which a matt sample shows too:
// each LED sees a normal of its own.

#include "proc/quality/tilt.h"

namespace gonio::proc {

/// Flags each cell TiltCorrected.
[[nodiscard]] SampleSet tiltCorrected(const SampleSet& sample, const TiltEstimate& estimate);

/// As it is, but for what the tilt that was found, and its uncertainty, may do to it.
[[nodiscard]] SampleSet withTiltUncertainty(SampleSet sample, const TiltEstimate& estimate);

}  // namespace gonio::proc
