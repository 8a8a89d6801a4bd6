#include "proc/export/sample_fill.h"

#include <cmath>
#include <limits>

#include "proc/core/parallel.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void put(CellSamples& cells, std::size_t cell, Band band, const Answer& answer) {
    if (std::isnan(answer.f[band])) {
        cells.flags[cell] = Flags(answer.flags).clear(Flag::Measured);
        return;
    }
    cells.f[cell] = answer.f[band];
    cells.uRandom[cell] = answer.uRandom ? (*answer.uRandom)[band] : kNan;
    cells.uSystematic[cell] = answer.uSystematic ? (*answer.uSystematic)[band] : kNan;
    // One part known and the other not: what is not known of is not there.
    if (answer.uRandom && !answer.uSystematic) cells.uSystematic[cell] = 0;
    if (answer.uSystematic && !answer.uRandom) cells.uRandom[cell] = 0;
    cells.nEff[cell] = 1;
    cells.flags[cell] = Flags(answer.flags).set(Flag::Measured);
}

void count(FilledSample& filled, const CellSamples& cells) {
    filled.asked += cells.size();
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        if (!cells.present(cell)) ++filled.unanswered;
        if (cells.present(cell) && cells.flags[cell].has(Flag::Extrapolated)) ++filled.extrapolated;
    }
}

LedTable askedTable(const Scatterer& from, LedTable led, const std::vector<Band>& bands) {
    for (const Band band : bands) {
        led.bands[index(band)] = CellSamples::missing(CellGrid::count());
    }
    parallelFor(CellGrid::count(), [&](IndexRange range) {
        for (std::size_t cell = range.begin; cell < range.end; ++cell) {
            const Answer answer = from.answer(pairInSample(led, CellGrid::centre(cell)));
            for (const Band band : bands) put(led.bands[index(band)], cell, band, answer);
        }
    });
    return led;
}

}  // namespace

FilledSample fillSample(const Scatterer& from, const SampleGrid& grid, const Metadata& about) {
    FilledSample filled;
    filled.set.info = infoOf(about);
    for (const double rotation : grid.rotationDeg) {
        for (const double incidence : grid.incidenceDeg) {
            LedTable led{.incidence = Radians::fromDegrees(incidence),
                         .rotation = rotationOf(rotation),
                         .bands = {}};
            filled.set.leds.push_back(askedTable(from, std::move(led), grid.bands));
            for (const Band band : grid.bands) {
                count(filled, filled.set.leds.back().bands[index(band)]);
            }
        }
    }
    return filled;
}

}  // namespace gonio::proc
