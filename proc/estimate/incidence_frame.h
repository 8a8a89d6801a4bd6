#pragma once
// Where, on the sheet of another incidence, the direction lies that corresponds to a given one:
// what an interpolation between incidences keeps fixed while wi moves.
//   SameDirection     wo itself. A lobe appears twice.
//   SpecularRelative  polar coordinates about the mirror direction (proc/core/coordinates.h), as
//                     Zemax and seed 004 do.
//   DirectionCosine   the difference of direction cosines from the mirror direction [Harvey1976].
//   HalfVector        the half vector: the lobe of any microfacet surface stays in place.
// The light stands at phi = 0. What falls below 89.5 degrees is lifted to it along its azimuth.

#include <optional>
#include <string_view>

#include "proc/core/direction.h"
#include "proc/models/kernel.h"

namespace gonio::proc {

enum class IncidenceFrame {
    SameDirection,
    SpecularRelative,
    DirectionCosine,
    HalfVector
};

/// The pair turned about the normal so that the light stands at phi = 0; at the normal as it is.
[[nodiscard]] LightView withLightAtZero(const LightView& pair);

/// The directions of a pair of components.
[[nodiscard]] LightView viewOf(const Pair<double>& pair);

/// wo at incidence `sheet` that corresponds to pair.out; pair.in at phi = 0.
[[nodiscard]] Direction onSheet(IncidenceFrame frame, const LightView& pair, Radians sheet);

}  // namespace gonio::proc
