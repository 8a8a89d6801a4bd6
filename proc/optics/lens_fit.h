#pragma once
// The lens map of one rig from mirror spots: where each known direction was seen.

#include <Eigen/Core>
#include <span>

#include "proc/core/result.h"
#include "proc/optics/lens_map.h"

namespace gonio::proc {

struct MirrorSpot {
    Direction direction;  ///< known from the LED and the wedge
    SensorPoint at;
    double sigma = 0;  ///< of either coordinate, sensor pixels
};

struct LensFit {
    LensMap map;
    Eigen::MatrixXd covariance;  ///< of LensMap::values(), widened where the spots scatter more
    double rmsPixels = 0;        ///< distance of the spots from the map
    double worstPixels = 0;

    /// Standard uncertainty of the direction that the map gives where wo falls, per axis.
    [[nodiscard]] Radians uncertainty(const Direction& wo) const;
};

/// Starts from an even f-theta lens about `middle`. Quality error when the spots leave the map
/// undetermined (all from one placement), when there are fewer than 5, or when they do not lie
/// within half a degree of any such map.
[[nodiscard]] Result<LensFit> fitLens(std::span<const MirrorSpot> spots,
                                      SensorPoint middle,
                                      double pixelsPerDegree);

}  // namespace gonio::proc
