#pragma once
// A SpecularTable made by asking a Scatterer at each node, one band: the way from anything that
// answers to a Zemax file. A node without an answer holds 0, as the format wants, and is counted.
// TIS is the integral of f cos(theta_o) over the hemisphere, on half-degree rings of 360 sectors
// whose weights are exact for a Lambertian; what does not answer adds nothing to it.

#include "proc/core/scatterer.h"
#include "proc/table/specular_table.h"

namespace gonio::proc {

/// The directions of a table, in degrees.
struct SpecularGrid {
    TableSymmetry symmetry = TableSymmetry::Asymmetrical;
    std::vector<double> rotationDeg{0}, incidenceDeg, azimuthDeg, radialDeg;

    /// Azimuth and radial in steps of 1 degree, radial 0..180, at these incidences.
    [[nodiscard]] static SpecularGrid oneDegree(std::vector<double> incidenceDeg,
                                                TableSymmetry symmetry);
};

struct FilledTable {
    SpecularTable table;
    std::size_t nodes = 0;         ///< above the horizon
    std::size_t unanswered = 0;    ///< of these, without an answer: 0 in the table
    std::size_t exactZero = 0;     ///< answered 0: reads back as missing
    std::size_t uncertain = 0;     ///< answered with an uncertainty, which the table cannot hold
    std::size_t extrapolated = 0;  ///< answered from beyond what was measured
};

[[nodiscard]] FilledTable fillTable(const Scatterer& from, const SpecularGrid& grid, Band band);

/// R, G and B in one table, whose counts are those of all three; of a scatterer of one band a
/// monochrome table.
[[nodiscard]] FilledTable fillBands(const Scatterer& from, const SpecularGrid& grid);

/// Integral of f cos(theta_o) over the hemisphere for the light at wi.
[[nodiscard]] double totalScatter(const Scatterer& from, const Direction& wi, Band band);

}  // namespace gonio::proc
