#include "proc/estimate/sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/optics/cell_blend.h"
#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::int16_t kNotFilled = -1;

using Neighbours = std::vector<std::vector<std::uint32_t>>;

/// Sectors of another row that touch a cell; the ends of an interval of phi belong to both.
void addTouching(std::vector<std::uint32_t>& list, const CellBounds& bounds, int row) {
    const int sectors = CellGrid::sectors(row);
    const double width = 2 * kPi / sectors;
    constexpr double kRounding = 1e-9;
    const int first = static_cast<int>(std::ceil(bounds.phiLow.value() / width - kRounding)) - 1;
    const int last = static_cast<int>(std::floor(bounds.phiHigh.value() / width + kRounding));
    for (int s = first; s <= last; ++s) {
        const int sector = ((s % sectors) + sectors) % sectors;
        list.push_back(static_cast<std::uint32_t>(CellGrid::index({row, sector})));
    }
}

std::vector<std::uint32_t> touching(std::size_t cell) {
    const CellPlace at = CellGrid::place(cell);
    const CellBounds bounds = CellGrid::bounds(cell);
    std::vector<std::uint32_t> list;
    for (int row = std::max(0, at.row - 1); row <= std::min(CellGrid::kRows - 1, at.row + 1);
         ++row) {
        addTouching(list, bounds, row);
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    std::erase(list, static_cast<std::uint32_t>(cell));
    return list;
}

}  // namespace

const std::vector<std::uint32_t>& neighboursOf(std::size_t cell) {
    static const Neighbours all = [] {
        Neighbours lists(CellGrid::count());
        for (std::size_t i = 0; i < lists.size(); ++i) lists[i] = touching(i);
        return lists;
    }();
    return all[cell];
}

Sheet::Cells Sheet::Cells::missing() {
    const std::vector none(CellGrid::count(), kNan);
    return {none, none, none};
}

std::optional<Sheet> Sheet::over(Cells cells) {
    const auto there = [](double v) { return !std::isnan(v); };
    if (std::none_of(cells.value.begin(), cells.value.end(), there)) return std::nullopt;
    return Sheet(std::move(cells));
}

Sheet::Sheet(Cells cells) : cells_(std::move(cells)), steps_(CellGrid::count(), kNotFilled) {
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        if (!std::isnan(cells_.value[i])) steps_[i] = 0;
    }
    fill();
}

void Sheet::fill() {
    std::vector<std::uint32_t> open;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        if (steps_[i] == kNotFilled) open.push_back(static_cast<std::uint32_t>(i));
    }
    for (std::int16_t layer = 1; !open.empty(); ++layer) {
        std::vector<std::uint32_t> left;
        for (const std::uint32_t cell : open) {
            double count = 0;
            SheetValue sum;
            for (const std::uint32_t near : neighboursOf(cell)) {
                if (steps_[near] == kNotFilled || steps_[near] == layer) continue;
                ++count;
                sum.value += cells_.value[near];
                sum.uRandom += cells_.uRandom[near];
                sum.uSystematic += cells_.uSystematic[near];
            }
            if (count == 0) {
                left.push_back(cell);
                continue;
            }
            cells_.value[cell] = sum.value / count;
            cells_.uRandom[cell] = sum.uRandom / count;
            cells_.uSystematic[cell] = sum.uSystematic / count;
            steps_[cell] = layer;
        }
        open = std::move(left);
    }
}

SheetValue Sheet::at(const Direction& wo) const {
    SheetValue sum;
    double variance = 0;
    const CellBlend blend(wo);
    for (const CellWeight& one : blend.cells()) {
        const double random = one.weight * cells_.uRandom[one.cell];
        sum.value += one.weight * cells_.value[one.cell];
        variance += random * random;
        sum.uSystematic += one.weight * cells_.uSystematic[one.cell];
        sum.steps += one.weight * steps_[one.cell];
    }
    sum.uRandom = std::sqrt(variance);
    return sum;
}

}  // namespace gonio::proc
