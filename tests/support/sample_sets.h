#pragma once
// Measured samples made up for tests.

#include <cmath>

#include "proc/optics/cell_grid.h"
#include "proc/table/sample_set.h"

namespace gonio::test {

/// f = value(theta_i, cell centre) in every cell up to 75 degrees; beyond: missing, blocked.
template <class F>
proc::LedTable ledTable(Radians incidence, const F& value) {
    proc::LedTable led;
    led.incidence = incidence;
    for (const Band band : kBands) {
        auto cells = proc::CellSamples::missing(proc::CellGrid::count());
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (proc::CellGrid::place(i).row >= 75) {
                cells.flags[i] = Flags{Flag::Blocked};
                continue;
            }
            const double f = value(incidence, proc::CellGrid::centre(i));
            cells.f[i] = f * (1.0 + static_cast<double>(index(band)));
            cells.uRandom[i] = 0.01 * f;
            cells.uSystematic[i] = 0.02 * f;
            cells.nEff[i] = 44;
            cells.flags[i] = Flags{Flag::Measured};
        }
        led.bands[index(band)] = std::move(cells);
    }
    return led;
}

template <class F>
proc::SampleSet sampleSet(const F& value) {
    proc::SampleSet set;
    set.info.name = "test tile";
    for (const Radians incidence : {0_deg, 20_deg, 40_deg, 60_deg}) {
        set.leds.push_back(ledTable(incidence, value));
    }
    return set;
}

}  // namespace gonio::test
