#include "proc/table/achieved.h"

#include "proc/core/median.h"

namespace gonio::proc {

std::optional<double> achievedUncertainty(const SampleSet& set) {
    std::vector<double> relative;
    for (const LedTable& led : set.leds) {
        for (const CellSamples& cells : led.bands) {
            for (std::size_t cell = 0; cell < cells.size(); ++cell) {
                if (cells.present(cell) && cells.f[cell] > 0) {
                    relative.push_back(cells.at(cell).u() / cells.f[cell]);
                }
            }
        }
    }
    if (relative.empty()) return std::nullopt;
    return median(std::move(relative));
}

}  // namespace gonio::proc
