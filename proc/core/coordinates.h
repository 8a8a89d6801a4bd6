#pragma once
// Coordinates of a pair (wi, wo) and their exact inverses; round trips hold to 1e-12 in double
// everywhere, poles and grazing included.
//
//  - spherical: theta, phi of each direction.
//  - specular-relative, as in Zemax files: radial = angle between wo and the mirror direction s of
//    wi; azimuth about s, 0 from s toward the normal, 90 degrees along v = s x u. At wi = n the
//    limit is taken: u points to the side the light comes from, at its azimuth phi_i.
//  - half/difference [Rusinkiewicz1998]: the half vector h = normalise(wi + wo) in spherical
//    coordinates, and wi in the frame of h, turned by -phi_h about n, then by -theta_h about y.
//
// At a pole the azimuth carries no information and is 0. wo = -wi has no half vector; see there.

#include <optional>

#include "proc/core/direction.h"

namespace gonio {

struct SpecularRelative {
    Radians radial;   ///< [0, pi]
    Radians azimuth;  ///< [0, 2 pi)
};

/// phiIn names the side the light comes from where wi itself cannot (at the pole).
[[nodiscard]] SpecularRelative toSpecularRelative(const LightView& pair, Radians phiIn = {});
/// wo from wi and specular-relative coordinates.
[[nodiscard]] Direction fromSpecularRelative(const Direction& wi,
                                             const SpecularRelative& at,
                                             Radians phiIn = {});

struct HalfDifference {
    Radians thetaHalf, phiHalf, thetaDiff, phiDiff;
};

/// Empty where wi = -wo to rounding: there is no half vector.
[[nodiscard]] std::optional<HalfDifference> toHalfDifference(const LightView& pair);
[[nodiscard]] LightView fromHalfDifference(const HalfDifference& at);

}  // namespace gonio
