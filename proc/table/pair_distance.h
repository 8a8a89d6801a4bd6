#pragma once
// How far apart two pairs (wi, wo) are. Plain: the Euclidean distance of the six components of both
// unit vectors,
//
//     d^2 = |wi - wi'|^2 + |wo - wo'|^2,
//
// so that 1 degree in one direction is 0.01745, and no two pairs are farther apart than
// sqrt(8). A symmetry of the surface makes pairs equal; the distance is then the least over all
// pairs equal to the first:
//
//  - isotropic: both directions turned about the normal by a common angle. With p the components
//    across the normal as complex numbers x + iy, the best turn is the phase of
//    conj(p_i) p_i' + conj(p_o) p_o' [orthogonal Procrustes problem in the plane].
//  - plane: isotropic, and mirrored in the plane of incidence.
//
// Each is a metric on the classes of equal pairs: 0 for equal pairs alone, with the triangle
// inequality. At wi = n the azimuth of wi does not exist and does not matter: the best turn is then
// the one that lays wo on wo'. It is continuous there, which a distance of pairs turned to
// phi_i = 0 is not.

#include <array>

#include "proc/core/direction.h"

namespace gonio::proc {

enum class PairSymmetry {
    None,
    Isotropic,
    Plane
};

[[nodiscard]] double squaredDistance(const LightView& from,
                                     const LightView& to,
                                     PairSymmetry symmetry);

/// Six coordinates of a pair whose Euclidean distance is never larger than the distance above, so
/// that a tree over them leaves out only what is too far. Without symmetry they are the components
/// and the two distances equal; else they do not change under the symmetry, and the distance is at
/// most sqrt(2) times theirs, in the limit of near pairs the same.
using PairPlace = std::array<double, 6>;
[[nodiscard]] PairPlace placeOf(const LightView& pair, PairSymmetry symmetry);

}  // namespace gonio::proc
