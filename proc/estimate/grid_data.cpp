#include "proc/estimate/grid_data.h"

#include "proc/fit/data_maker.h"
#include "proc/optics/cell_grid.h"

namespace gonio::proc {

BrdfData gridDataOf(const Scatterer& from,
                    const std::vector<Radians>& incidences,
                    const DataOptions& options) {
    DataMaker maker(options);
    maker.data().uKnown = false;
    maker.data().bands = from.bandCount();
    for (const Radians incidence : incidences) {
        const auto group = static_cast<std::uint16_t>(maker.data().incidences.size());
        maker.data().incidences.push_back(incidence);
        const Direction wi = Direction::fromSpherical(incidence, Radians(0));
        for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
            const LightView pair{.in = wi, .out = CellGrid::centre(cell)};
            const Answer answer = from.answer(pair);
            if (!answer.present()) {
                maker.leaveOut();
                continue;
            }
            FitRow& row = maker.add(pair);
            row.group = group;
            row.cell = static_cast<std::int32_t>(cell);
            row.patch = static_cast<std::uint32_t>(patchOf(cell));
            row.solidAngle = CellGrid::solidAngle(cell);
            for (std::size_t b = 0; b < maker.data().bandsUsed(); ++b) row.f[b] = answer.f.value[b];
        }
    }
    return std::move(maker).finished();
}

}  // namespace gonio::proc
