#pragma once
// Linear interpolation between the nearest samples along the axes of the spherical coordinates
// theta_i, phi_i, theta_o, phi_o [Cezner2023, 6.1.3: LinearAxisInterpolator]. The thesis leaves
// open how neighbours off the axes are treated; spherical_lines.h says what is done here: on a full
// grid it is multilinear, beside the last sample of an axis constant.
//
// Of one sample at the pair's own coordinates: source measured. No sample within reach: no answer.
// Across the pole of theta_o it does not look: there the innermost ring answers.

#include <memory>

#include "proc/core/result.h"
#include "proc/estimate/spherical_lines.h"

namespace gonio::proc {

/// A Usage error where a reach is negative or not finite, or no point may be looked at.
[[nodiscard]] Result<std::unique_ptr<Scatterer>> makeAxisLinear(const ScatteredSet& data,
                                                                const AxisReach& reach = {});

}  // namespace gonio::proc
