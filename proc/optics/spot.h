#pragma once
// Finds the image of one LED in a mirror: the only bright spot of a merged picture.

#include "proc/core/result.h"
#include "proc/optics/lens_map.h"
#include "proc/radiance/merge.h"

namespace gonio::proc {

struct Spot {
    SensorPoint at;     ///< intensity-weighted centroid
    double sigma = 0;   ///< standard uncertainty of either coordinate, sensor pixels
    double pixels = 0;  ///< sensor pixels above a tenth of its peak
};

/// Quality error, in words for the operator, when there is no spot, more than one, one that is too
/// large for a source of a degree, or one that is saturated.
[[nodiscard]] Result<Spot> findSpot(const MergedState& state);

}  // namespace gonio::proc
