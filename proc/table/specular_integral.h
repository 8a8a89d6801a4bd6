#pragma once
// What a table's own numbers say is scattered from one light direction: the integral of f
// cos(theta_o) over the hemisphere in the table's coordinates, f bilinear between the nodes. A node
// without data counts as 0, so that a rim that was not measured falls off to nothing. The ends of
// the axes are those of the look-up (specular_lookup.h): azimuths close the circle where their gap
// is a step like the others, and axes of cells' centres go on to the pole and to the mirror plane.
// What lies beyond adds nothing.

#include <cstddef>

#include "proc/table/specular_table.h"

namespace gonio::proc {

/// Fraction of the incident power; of the rotation and incidence of `light`. To some 1e-4 of a
/// constant f over one-degree axes.
[[nodiscard]] double specularIntegral(const SpecularTable& table,
                                      std::size_t plane,
                                      const TableNode& light);

}  // namespace gonio::proc
