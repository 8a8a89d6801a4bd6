#include "proc/report/sample_cells.h"

#include <algorithm>
#include <cmath>

#include "proc/core/number_text.h"
#include "proc/report/plot_request.h"

namespace gonio::proc {

std::vector<Band> measuredBands(const SampleSet& sample) {
    std::vector<Band> bands;
    for (const Band band : kBands) {
        const bool any = std::any_of(sample.leds.begin(), sample.leds.end(), [&](const auto& led) {
            return cellsOf(led, band) != nullptr;
        });
        if (any) bands.push_back(band);
    }
    return bands;
}

std::vector<Radians> incidencesOf(const SampleSet& sample) {
    std::vector<Radians> incidences;
    incidences.reserve(sample.leds.size());
    for (const LedTable& led : sample.leds) incidences.push_back(led.incidence);
    return incidences;
}

std::string turnLabel(Radians rotation) {
    // Rotations differ by a hundredth of a degree at least (rotations.h).
    const double thousandths = std::round(rotation.degrees() * 1000) / 1000;
    return thousandths == 0 ? "" : "turned " + shortest(thousandths) + " deg";
}

std::string lightLabel(const LedTable& led) {
    const std::string turn = turnLabel(led.rotation);
    return degreesLabel(led.incidence) + (turn.empty() ? "" : ", " + turn);
}

std::vector<double> relativeUncertainties(const CellSamples& cells) {
    std::vector<double> relative;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        if (!cells.present(cell) || !(cells.f[cell] > 0)) continue;
        const double u = cells.at(cell).u() / cells.f[cell];
        if (std::isfinite(u)) relative.push_back(u);
    }
    return relative;
}

Radians fieldOf(const SampleSet& sample) {
    int rows = 0;
    for (const LedTable& led : sample.leds) {
        for (const Band band : kBands) {
            const CellSamples* cells = cellsOf(led, band);
            for (std::size_t cell = 0; cells != nullptr && cell < cells->size(); ++cell) {
                if (cells->present(cell)) rows = std::max(rows, CellGrid::place(cell).row + 1);
            }
        }
    }
    return Radians::fromDegrees(rows);
}

}  // namespace gonio::proc
