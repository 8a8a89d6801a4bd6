#include "proc/estimate/coverage.h"

#include <algorithm>
#include <cmath>

#include "proc/optics/cell_grid.h"
#include "proc/table/axis.h"

namespace gonio::proc {

Coverage::Coverage(const BrdfData& data, const std::vector<bool>& groups)
    : exchanges_(data.exchanges) {
    const std::size_t cellCount = CellGrid::count();
    std::array<std::vector<bool>, 3> measured;  // by group and cell
    for (auto& band : measured) band.assign(data.incidences.size() * cellCount, false);
    for (const FitRow& row : data.rows) {
        const auto cell = cellOf(data, row);
        if (!cell) continue;
        for (std::size_t b = 0; b < 3; ++b) {
            const double f = row.f[std::min(b, data.bandsUsed() - 1)];
            if (!std::isnan(f)) measured[b][row.group * cellCount + *cell] = true;
        }
    }
    for (std::size_t b = 0; b < 3; ++b) {
        const auto* alike = std::find(measured.begin(), measured.begin() + b, measured[b]);
        const auto first = static_cast<std::size_t>(alike - measured.begin());
        kindOf_[b] = first < b ? kindOf_[first] : kinds_.size();
        if (first == b) kinds_.push_back(kindOf(data, groups, measured[b]));
    }
}

Coverage::Kind Coverage::kindOf(const BrdfData& data,
                                const std::vector<bool>& groups,
                                const std::vector<bool>& measured) {
    Kind kind;
    for (std::size_t g = 0; g < data.incidences.size(); ++g) {
        if (!groups[g]) continue;
        Sheet::Cells cells = Sheet::Cells::missing();
        for (std::size_t cell = 0; cell < cells.value.size(); ++cell) {
            if (measured[g * cells.value.size() + cell]) cells.value[cell] = 1;
        }
        auto sheet = Sheet::over(std::move(cells));
        if (!sheet) continue;
        kind.deg.push_back(data.incidences[g].degrees());
        kind.sheets.push_back(std::move(*sheet));
    }
    return kind;
}

std::array<Reach, 3> Coverage::at(const LightView& pair) const {
    std::array<Reach, 3> reach;
    for (std::size_t b = 0; b < 3; ++b) {
        const auto* alike = std::find(kindOf_.begin(), kindOf_.begin() + b, kindOf_[b]);
        const auto first = static_cast<std::size_t>(alike - kindOf_.begin());
        reach[b] = first < b ? reach[first] : kinds_[kindOf_[b]].at(pair);
    }
    return reach;
}

Reach Coverage::Kind::at(const LightView& pair) const {
    if (deg.empty()) return {.between = 1, .beyondIncidence = Radians(kPi / 2), .steps = 90};
    const double atDeg = pair.in.theta().degrees();
    const double inside = std::clamp(atDeg, deg.front(), deg.back());
    const AxisPlace place = placeOn(deg, inside).value_or(AxisPlace{});
    const double low = sheets[place.low].at(pair.out).steps;
    const double high = sheets[place.high].at(pair.out).steps;
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
