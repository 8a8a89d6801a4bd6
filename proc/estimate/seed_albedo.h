#pragma once
// Baseline: the directional albedo as a straightforward program sums it over a 1 degree grid of
// directions, theta = 0..last, phi = 0..359 degrees,
//     sum of f cos(theta) sin(theta) dtheta dphi.
// The pole has weight 0, the outermost ring its full weight though half of it lies outside, what is
// beyond counts as nothing, and so does a node without an answer. Nothing says how wrong it is. It
// stands here to be measured against, and serves nothing else.

#include "proc/core/scatterer.h"

namespace gonio::proc {

/// `lastDegree` in whole degrees: what the rig sees.
[[nodiscard]] LedBands riemannAlbedo(const Scatterer& of, const Direction& wi, int lastDegree = 75);

}  // namespace gonio::proc
