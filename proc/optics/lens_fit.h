#pragma once
// The lens map of one rig from mirror spots: where each known direction was seen.

#include <Eigen/Core>
#include <span>
#include <vector>

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
};

/// Standard uncertainty of the direction that a fitted map gives where wo falls, per axis: the
/// covariance through numerical slopes. Half a turn where the map gives none.
class DirectionUncertainty {
public:
    explicit DirectionUncertainty(const LensFit& fit);
    [[nodiscard]] Radians operator()(const Direction& wo) const;

private:
    struct Slope {
        LensMap higher, lower;  // with one parameter moved
        double width = 0;
    };
    LensMap map_;
    std::vector<Slope> slopes_;  // by parameter
    Eigen::MatrixXd covariance_;
};

/// Starts from an even f-theta lens about `middle`. Quality error when the spots leave the map
/// undetermined (all from one placement), when there are fewer than 5, or when they do not lie
/// within half a degree of any such map.
[[nodiscard]] Result<LensFit> fitLens(std::span<const MirrorSpot> spots,
                                      SensorPoint middle,
                                      double pixelsPerDegree);

}  // namespace gonio::proc
