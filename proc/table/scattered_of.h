#pragma once
// Scattered sets out of what is measured on a grid: each cell or node with data is one sample.

#include <optional>

#include "proc/table/sample_set.h"
#include "proc/table/scattered_set.h"
#include "proc/table/specular_table.h"

namespace gonio::proc {

struct Scattered {
    ScatteredSet set;
    std::size_t leftOut = 0;  ///< cells or nodes above the horizon without a usable value
};

/// The cells that are usable (CellSamples) in all three bands, or in `only` one band: then f is the
/// same in the three, BandCount::One. The light stands at phi = 0, the pair's wo at the cell's
/// centre; flags are those of all bands together. The rig sees isotropic samples only, so that
/// this is the least symmetry that makes sense.
[[nodiscard]] Result<Scattered> scatteredOf(const SampleSet& sample,
                                            std::optional<Band> only = {},
                                            PairSymmetry symmetry = PairSymmetry::Isotropic);

/// The nodes with data, each direction once; BandCount::One. Symmetry as the table says: of several
/// rotations none, of one rotation isotropic, of a plane-symmetrical table also mirrored. A Usage
/// error for XYZ and for transmission.
[[nodiscard]] Result<Scattered> scatteredOf(const SpecularTable& table);

}  // namespace gonio::proc
