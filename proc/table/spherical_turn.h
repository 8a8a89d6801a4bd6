#pragma once
// The same table with its azimuths counted from another zero, as another format wants them: every
// node keeps its direction and its value.

#include "proc/table/spherical_table.h"

namespace gonio::proc {

/// The mirror direction of the light then lies at `mirrorAzimuthDeg`, in [0, 360). Azimuths lie in
/// [0, 360]; 360 stands beside 0 where the first and the last azimuth of a block were one turn
/// apart. A plane-symmetrical half is mirrored to the side that lies within [0, 360).
[[nodiscard]] SphericalTable withMirrorAt(SphericalTable table, double mirrorAzimuthDeg);

/// Both sides of a plane-symmetrical table, and an azimuth of 360 beside 0 where the azimuths of a
/// block cover the circle. Azimuths lie in [0, 360].
[[nodiscard]] SphericalTable wholeCircle(SphericalTable table);

}  // namespace gonio::proc
