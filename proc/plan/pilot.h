#pragma once
// What the pilot frames say about a state: for each cell (or each class of alike cells, a
// histogram) how bright its pixels are.

#include <span>
#include <vector>

#include "proc/core/bands.h"
#include "proc/optics/binning.h"

namespace gonio::proc {

/// A cell, or `count` alike cells; none (a place that the rig does not see) is left out. An
/// infinite rate is one that saturates all pilots.
struct PlanCell {
    double f = 0;           ///< 1/sr
    double rate = 0;        ///< electrons per second at full level, of one pixel, all light
    double pixels = 0;      ///< independent ones in one cell
    double background = 0;  ///< of `rate`: light that is not the sample's
    int count = 1;

    /// The sample's own light.
    [[nodiscard]] double signal() const { return rate - background; }
    /// Finite numbers and pixels above 0.
    [[nodiscard]] bool usable() const;
    [[nodiscard]] bool blinding() const;
};

/// One LED and band.
struct StatePilot {
    int led = 0;
    Band band = Band::R;
    std::vector<PlanCell> cells;
};

/// What a cell's signal means: the calibration turns it into f.
struct Responsivity {
    std::span<const double> signalPerF;  ///< of each cell: signal per 1/sr
    std::span<const double> dark;        ///< of each cell: signal of f = 0
};

/// The cells of a pilot that was merged and binned (proc/optics/binning.h). A cell that saturates
/// is blinding; one that is blocked counts 0; one without a responsivity becomes NaN, which the
/// planner leaves out and counts. `signal` and both spans run over CellGrid.
[[nodiscard]] std::vector<PlanCell> pilotCells(const CellSignal& signal,
                                               const Responsivity& responsivity,
                                               const Binning& binning);

}  // namespace gonio::proc
