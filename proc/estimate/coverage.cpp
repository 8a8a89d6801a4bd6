#include "proc/estimate/coverage.h"

#include <algorithm>
#include <cmath>

#include "proc/optics/cell_grid.h"
#include "proc/table/axis.h"

namespace gonio::proc {

Coverage::Coverage(const BrdfData& data, const std::vector<bool>& groups) {
    std::vector<Sheet::Cells> cells(data.incidences.size(), Sheet::Cells::missing());
    for (const FitRow& row : data.rows) {
        if (const auto cell = cellOf(data, row)) cells[row.group].value[*cell] = 1;
    }
    for (std::size_t g = 0; g < cells.size(); ++g) {
        if (!groups[g]) continue;
        auto sheet = Sheet::over(std::move(cells[g]));
        if (!sheet) continue;
        deg_.push_back(data.incidences[g].degrees());
        sheets_.push_back(std::move(*sheet));
    }
}

Reach Coverage::at(const LightView& pair) const {
    if (deg_.empty()) return {.between = 1, .beyondIncidence = Radians(kPi / 2), .steps = 90};
    const double atDeg = pair.in.theta().degrees();
    const double inside = std::clamp(atDeg, deg_.front(), deg_.back());
    const AxisPlace place = placeOn(deg_, inside).value_or(AxisPlace{});
    const double low = sheets_[place.low].at(pair.out).steps;
    const double high = sheets_[place.high].at(pair.out).steps;
    return {.between = 4 * place.t * (1 - place.t),
            .beyondIncidence = Radians::fromDegrees(std::abs(atDeg - inside)),
            .steps = std::max(low, high)};
}

std::optional<std::size_t> cellOf(const BrdfData& data, const FitRow& row) {
    if (row.cell >= 0) return static_cast<std::size_t>(row.cell);
    const Vec<double>& out = data.nodes[row.firstNode].pair.out;
    const auto wo = Direction::fromVector({out.x, out.y, out.z});
    return wo ? CellGrid::cellAt(*wo) : std::nullopt;
}

}  // namespace gonio::proc
