#pragma once
// A BRDF in the adaptive parametrisation [Dupuy2018], as RGL's .bsdf files hold it: a microfacet
// distribution of normals, and for each direction of the light the values on the unit square that
// the distribution of visible normals is warped to. Angles are radians, as in the file.
//
// Directions on the square: x = sqrt(2 theta / pi), y = (phi + pi) / (2 pi). With h the half vector
// of wi and wo, f cos(theta_o) = value(s) ndf(h) / (4 sigma(wi)), s the warped place of h; without
// `jacobian` it is value(s) alone.

#include <vector>

#include "proc/core/direction.h"
#include "proc/table/channel.h"
#include "proc/table/warp2d.h"

namespace gonio::proc {

struct TensorTable {
    std::vector<float> thetaIn;  ///< of the light, ascending
    /// Up to two: isotropic, h counts from the light's azimuth. Else ascending over the circle, a
    /// half or a quarter of it, whose other parts are the same by symmetry.
    std::vector<float> phiIn;
    bool jacobian = true;
    GridStack ndf, sigma;           ///< one slice each
    GridStack vndf, luminance;      ///< phiIn > thetaIn
    std::vector<Channel> channels;  ///< R, G, B, or wavelengths
    GridStack values;               ///< phiIn > thetaIn > channel

    [[nodiscard]] bool isotropic() const { return phiIn.size() <= 2; }
    /// Which part of the circle phiIn covers: 1, 2, 4; of isotropic tables 1.
    [[nodiscard]] int reduction() const;
};

/// Where a direction stands on the square; phi from -pi to pi is y from 0 to 1, and goes round.
[[nodiscard]] SquarePoint squareOf(Radians theta, Radians phi);
/// The inverse, for tables to be filled.
[[nodiscard]] Direction directionOf(const SquarePoint& at);
/// The place of node `i` of a slice, x fastest; the outermost nodes lie on the edges.
[[nodiscard]] SquarePoint nodeOf(const GridStack& grid, std::size_t i);

}  // namespace gonio::proc
