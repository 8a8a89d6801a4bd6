#pragma once
// The lens map of one rig from mirror spots: where each direction was seen that a light and a wedge
// make known. Wedges have tolerances, and what a wedge is wrong by moves all of its spots together;
// so their errors are estimated along with the lens, each drawn to zero by its tolerance, and what
// stays unknown of them is in the covariance of the map. The lights are taken to stand where the
// rig says.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "proc/core/result.h"
#include "proc/optics/lens_map.h"
#include "proc/optics/mirror.h"

namespace gonio::proc {

struct MirrorSpot {
    Wedge wedge;  ///< nominal
    Direction light;
    SensorPoint at;
    double sigma = 0;  ///< of either coordinate, sensor pixels
};

struct LensFit {
    LensMap map;
    Eigen::MatrixXd covariance;  ///< of LensMap::values(), widened where the spots scatter more
    double rmsPixels = 0;        ///< distance of the spots from the map
    double worstPixels = 0;
};

/// d direction / d parameter of a map, in the order of LensMap::values().
using DirectionSlopes = Eigen::Matrix<double, 3, static_cast<int>(LensMap::kParameters)>;

/// Standard uncertainty of the direction that a fitted map gives where wo falls: the covariance
/// through numerical slopes. Half a turn where the map gives none.
class DirectionUncertainty {
public:
    explicit DirectionUncertainty(const LensFit& fit);
    [[nodiscard]] DirectionSpread operator()(const Direction& wo) const;

    /// Of the direction that the map gives where wo falls; empty where it gives none.
    [[nodiscard]] std::optional<DirectionSlopes> slopes(const Direction& wo) const;
    /// Of a direction wo that depends on the parameters like that.
    [[nodiscard]] DirectionSpread ofSlopes(const Direction& wo,
                                           const DirectionSlopes& slopes) const;

private:
    struct Slope {
        LensMap higher, lower;  // with one parameter moved
        double width = 0;
    };
    LensMap map_;
    std::vector<Slope> slopes_;  // by parameter
    Eigen::MatrixXd covariance_;
};

/// `wedgeTolerance`: standard uncertainty of a wedge's angle about either axis; zero takes the
/// nominal angles as they are. Starts from an even f-theta lens about `middle`. Quality error when
/// the spots leave the map undetermined (all from one placement), when there are fewer than 5, or
/// when they do not lie within half a degree of any such map.
[[nodiscard]] Result<LensFit> fitLens(std::span<const MirrorSpot> spots,
                                      SensorPoint middle,
                                      double pixelsPerDegree,
                                      Radians wedgeTolerance);

}  // namespace gonio::proc
