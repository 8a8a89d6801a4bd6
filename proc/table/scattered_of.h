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
/// same in the three, BandCount::One. Pairs are in the sample's own frame (pairInSample), wo at the
/// cell's centre; flags are those of all bands together. Unless said, the symmetry is none of
/// several rotations, and isotropic of one, which tells of no other.
[[nodiscard]] Result<Scattered> scatteredOf(const SampleSet& sample,
                                            std::optional<Band> only = {},
                                            std::optional<PairSymmetry> symmetry = {});

/// The nodes with data, each direction once; BandCount::One. Symmetry as the table says: of several
/// rotations none, of one rotation isotropic, of a plane-symmetrical table also mirrored. A Usage
/// error for XYZ and for transmission.
[[nodiscard]] Result<Scattered> scatteredOf(const SpecularTable& table);

}  // namespace gonio::proc
