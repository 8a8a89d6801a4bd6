#pragma once
// What a mirror on a wedge shows: the one placement whose directions are known without a lens map.

#include <span>

#include "proc/core/direction.h"

namespace gonio::proc {

/// The surface normal of a wedge is Ry(aboutY) Rx(aboutX) z, right-handed turns about the sample's
/// own axes.
struct Wedge {
    Radians aboutX;
    Radians aboutY;

    auto operator<=>(const Wedge&) const = default;
};

/// The nine placements of `calibrate mirror`: flat, and 15 and 25 degrees about x and y, both ways.
/// One placement alone has all its spots on one line and leaves the map singular. The steeper
/// wedges bring spots to where the rest only extrapolate to, and all of them average out what each
/// wedge's own angle is wrong by. A light that a wedge sends outside the field has no spot there.
[[nodiscard]] std::span<const Wedge> mirrorWedges();

/// The direction in which a mirror on `wedge` shows the light; below the horizon when it does.
[[nodiscard]] Direction mirroredBy(const Wedge& wedge, const Direction& light);

}  // namespace gonio::proc
