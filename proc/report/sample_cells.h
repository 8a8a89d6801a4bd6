#pragma once
// The cells of a sample that a report goes over.

#include <string>
#include <vector>

#include "proc/optics/cell_grid.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

/// Null where the band was not measured.
[[nodiscard]] inline const CellSamples* cellsOf(const LedTable& led, Band band) {
    const CellSamples& cells = led.bands[index(band)];
    return cells.size() == CellGrid::count() ? &cells : nullptr;
}

/// Those that any LED measured.
[[nodiscard]] std::vector<Band> measuredBands(const SampleSet& sample);
/// Of the LEDs, in their order.
[[nodiscard]] std::vector<Radians> incidencesOf(const SampleSet& sample);

/// "turned 90 deg": how the sample lay on the stage; empty at rotation 0.
[[nodiscard]] std::string turnLabel(Radians rotation);
/// Of a light among those of all rotations: "20 deg, turned 90 deg"; "20 deg" at rotation 0.
[[nodiscard]] std::string lightLabel(const LedTable& led);

/// Combined u over f of the cells that are present with f above 0; in no order.
[[nodiscard]] std::vector<double> relativeUncertainties(const CellSamples& cells);

/// The upper edge of the outermost row with a cell that is present; 0 where there is none.
[[nodiscard]] Radians fieldOf(const SampleSet& sample);

}  // namespace gonio::proc
