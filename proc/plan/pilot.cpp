#include "proc/plan/pilot.h"

#include <cassert>
#include <cmath>
#include <limits>

namespace gonio::proc {

bool PlanCell::usable() const {
    return std::isfinite(f) && std::isfinite(rate) && std::isfinite(background) &&
           std::isfinite(pixels) && pixels > 0;
}

bool PlanCell::blinding() const { return std::isinf(rate) && rate > 0; }

std::vector<PlanCell> pilotCells(const CellSignal& signal,
                                 const Responsivity& responsivity,
                                 const Binning& binning) {
    assert(signal.size() == CellGrid::count() && responsivity.dark.size() == signal.size() &&
           responsivity.signalPerF.size() == signal.size());
    std::vector<PlanCell> cells(signal.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        PlanCell& cell = cells[i];
        if (!signal.present(i)) {
            const bool saturated = signal.flags[i].has(Flag::Saturated);
            cell.rate = saturated ? std::numeric_limits<double>::infinity() : 0;
            cell.count = saturated ? 1 : 0;
            continue;
        }
        // A bin is the sum over its pixels of rate / cosine, per steradian.
        const double perPixel =
            CellGrid::centre(i).z() * CellGrid::solidAngle(i) / binning.pixelsIn(i);
        cell.f = (signal.signal[i] - responsivity.dark[i]) / responsivity.signalPerF[i];
        cell.rate = signal.signal[i] * perPixel;
        cell.background = responsivity.dark[i] * perPixel;
        cell.pixels = signal.nEff[i];
    }
    return cells;
}

}  // namespace gonio::proc
