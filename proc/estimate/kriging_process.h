#pragma once
// A Gaussian process over pairs of directions of an isotropic, reciprocal surface.
//
// Coordinates of a pair: (rho_i, x, |y|), the light at phi = 0 (at the normal: the view) and each
// direction on the equal-area disc, rho = sqrt(2) sin(theta / 2), which is drawn out towards
// grazing (rho (1 + g rho^6)), and x counted from the mirror direction, where that predicts better.
// Covariance of two pairs: Matern's of order 5/2 of their distance, averaged over exchanging light
// and view of either.

#include <Eigen/Core>
#include <vector>

#include "proc/core/direction.h"

namespace gonio::proc {

struct KrigingProcess {
    double length = 2;           ///< of the disc
    double incidenceWeight = 1;  ///< of rho_i in the square of a distance
    double grazing = 1;          ///< by how much the disc is drawn out at its rim
    bool fromMirror = false;
    double noise = 0.1;      ///< variance, relative to the process's
    double variance = 1e-2;  ///< of the values
    bool learned = false;    ///< else all of this is assumed
};

/// withLightAtZero; with the light at the normal, where an isotropic surface knows no azimuth, the
/// view at phi = 0.
[[nodiscard]] LightView isotropicPair(const LightView& pair);

/// A pair's place in a process's coordinates, both ways round.
struct KrigingPlace {
    Eigen::Vector3d straight = Eigen::Vector3d::Zero();
    Eigen::Vector3d exchanged = Eigen::Vector3d::Zero();
    double scale = 1;  ///< makes the correlation of a pair with itself 1
};
[[nodiscard]] KrigingPlace krigingPlace(const KrigingProcess& process, const LightView& pair);

/// Correlation of two pairs; of one with itself it is 1. All four ways count: exchanging light and
/// view does not keep distances.
[[nodiscard]] double correlation(const KrigingPlace& a, const KrigingPlace& b);
[[nodiscard]] Eigen::MatrixXd correlations(const std::vector<KrigingPlace>& at);

/// The process under which each of the values is predicted best from the others (leave-one-out
/// likelihood [Rasmussen2006, ch. 5]); the work grows with the cube of their number. Not `learned`
/// where there is nothing to learn from, as of values that are all 0.
[[nodiscard]] KrigingProcess learnedProcess(const std::vector<LightView>& pairs,
                                            const Eigen::VectorXd& values);

}  // namespace gonio::proc
