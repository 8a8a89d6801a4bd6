#pragma once
// The glare of one lens from what a mirror shows: an LED's spot is all the light there is, so what
// lies around it is glare, and light that comes past the mirror. The latter is the same where the
// mirror sends the spot out of the field; the difference of two such pictures is glare alone, but
// for the LED's drift between them, which is estimated along:
//     lit_b - (1 + e) unlit_b = L (a / N + h K(r_b) / n),      e drawn to 0 by the drift.
// b: squares of 16 x 16 pixels, r_b from the spot, L the spot's light, the rest as in glare.h.
//
// Where there is no glare the fit finds none within its uncertainty; a share below three of them is
// taken for none. Radius and exponent are fitted where the halo is seen; they do not matter where
// it is not.

#include <span>

#include "proc/core/result.h"
#include "proc/optics/glare.h"

namespace gonio::proc {

/// Two pictures of one LED and band: its spot in the field, and out of it.
struct MirrorPair {
    const MergedState& lit;
    const MergedState& unlit;
};

/// `lightDrift`: of an LED between two captures, relative, k = 1. Quality error when there is no
/// pair, or no spot in one of them (spot.h); when less than a hundred squares are left.
[[nodiscard]] Result<GlareSpread> fitGlare(std::span<const MirrorPair> pairs,
                                           const LensMap& map,
                                           Radians field,
                                           double lightDrift);

}  // namespace gonio::proc
