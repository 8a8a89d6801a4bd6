#pragma once
// The albedo of a measured sample, summed over its cells: with P the exact projected solid angle of
// a cell (the integral of cos(theta_o) over it; all cells together hold pi),
//     a = sum of f P,  u_random^2 = sum of (u_random P)^2,  u_systematic = sum of u_systematic P:
// cells are independent in what is random and of one mind in what is not. Cells without a usable
// value (beyond 75 degrees, behind the beam, saturated) add nothing, and `missing` says what share
// of pi they hold: the value is a lower bound of a surface whose f is not negative there. That f is
// a cell's mean weighted by solid angle, not by projected solid angle, leaves 1e-5 of a smooth f's
// albedo.

#include <vector>

#include "proc/estimate/albedo.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

/// Integral of cos(theta_o) over a cell of CellGrid, sr.
[[nodiscard]] double projectedSolidAngle(std::size_t cell);

/// Of one LED, all bands; a band that was not measured is NaN with `missing` 1. There is no
/// quadrature between cells: the error bound is 0, `evaluations` counts the cells that are summed.
[[nodiscard]] Albedo directionalAlbedo(const LedTable& led);

/// Likewise with what is missing filled in: where a cell has no value, the answer of `beyond` at
/// its centre. The uncertainty is empty where such an answer has none.
[[nodiscard]] Albedo filledAlbedo(const LedTable& led, const Scatterer& beyond);

/// Mean over rotations of the sample, each counting alike: independent in what is random, of one
/// mind in what is not. Unknown where one of them is. At least one.
[[nodiscard]] Albedo averagedAlbedo(const std::vector<Albedo>& rotations);

/// Of a whole sample, (1 / pi) integral of a cos(theta_i) dwi = integral of a d(sin^2(theta_i)),
/// a linear in sin^2(theta_i) between LEDs: LEDs are independent in what is random. Incidences
/// beyond the first and last LED count as missing. The error bound is of that line between LEDs,
/// twice what their second differences say; NaN below three LEDs and where two share an incidence,
/// where none can be had. Of several rotations, the average of each one's.
[[nodiscard]] Albedo meanAlbedo(const SampleSet& sample);

}  // namespace gonio::proc
