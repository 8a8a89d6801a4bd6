// Rows of a measured sample: its present cells.

#include <algorithm>
#include <cmath>

#include "proc/fit/data_maker.h"
#include "proc/optics/cell_grid.h"
#include "proc/solve/quadrature.h"

namespace gonio::proc {
namespace {

/// Gauss points per side of a cell, by its distance from the mirror direction.
std::size_t nodesPerSide(Radians fromMirror) {
    if (fromMirror < 3_deg) return 4;
    if (fromMirror < 6_deg) return 3;
    return fromMirror < 15_deg ? 2 : 1;
}

/// Weights by solid angle, summing to 1.
std::vector<WeightedNode> nodesOf(const LedTable& led, std::size_t cell, std::size_t perSide) {
    const auto pairTo = [&](const Direction& wo) { return pairOf<double>(pairInSample(led, wo)); };
    if (perSide == 1) return {{pairTo(CellGrid::centre(cell)), 1}};
    const CellBounds bounds = CellGrid::bounds(cell);
    const std::vector<QuadratureNode> rule = gaussLegendre(perSide);
    const double theta = (bounds.thetaHigh - bounds.thetaLow).value();
    const double phi = (bounds.phiHigh - bounds.phiLow).value();
    std::vector<WeightedNode> nodes;
    double sum = 0;
    for (const QuadratureNode& a : rule) {
        const Radians thetaO(bounds.thetaLow.value() + a.x * theta);
        for (const QuadratureNode& b : rule) {
            const Radians phiO(bounds.phiLow.value() + b.x * phi);
            nodes.push_back({pairTo(Direction::fromSpherical(thetaO, phiO)),
                             a.weight * b.weight * std::sin(thetaO.value())});
            sum += nodes.back().weight;
        }
    }
    for (WeightedNode& node : nodes) node.weight /= sum;
    return nodes;
}

FitRow& addCell(DataMaker& maker, const LedTable& led, std::size_t cell) {
    const Direction centre = CellGrid::centre(cell);
    const Direction mirror = Direction::fromSpherical(led.incidence, Radians(kPi));
    const Radians away = angleBetween({.in = mirror, .out = centre});
    FitRow& row = maker.add(nodesOf(led, cell, nodesPerSide(away)), centre.z());
    row.cell = static_cast<std::int32_t>(cell);
    row.patch = static_cast<std::uint32_t>(patchOf(cell));
    row.solidAngle = CellGrid::solidAngle(cell);
    return row;
}

/// A sample that was made of a file of plain values has none.
bool anyUncertainty(const SampleSet& set) {
    const auto known = [](double u) { return !std::isnan(u); };
    return std::any_of(set.leds.begin(), set.leds.end(), [&](const LedTable& led) {
        return std::any_of(led.bands.begin(), led.bands.end(), [&](const CellSamples& cells) {
            return std::any_of(cells.uRandom.begin(), cells.uRandom.end(), known);
        });
    });
}

}  // namespace

BrdfData fitDataOf(const SampleSet& set, const DataOptions& options) {
    DataMaker maker(options);
    maker.data().shared = budgetShares(set);
    maker.data().uKnown = anyUncertainty(set);
    for (std::size_t l = 0; l < set.leds.size(); ++l) {
        const LedTable& led = set.leds[l];
        const auto group = static_cast<std::uint16_t>(maker.data().incidences.size());
        maker.data().incidences.push_back(led.incidence);
        for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
            const auto usable = [&](const CellSamples& cells) { return cells.usable(cell); };
            if (std::none_of(led.bands.begin(), led.bands.end(), usable)) {
                maker.leaveOut();
                continue;
            }
            FitRow& row = addCell(maker, led, cell);
            row.group = group;
            for (std::size_t b = 0; b < 3; ++b) {
                const CellSamples& cells = led.bands[b];
                if (!usable(cells)) continue;
                row.f[b] = cells.f[cell];
                const BudgetShare& share = maker.data().shared[l][b];
                row.uRandom[b] = std::hypot(cells.uRandom[cell], share.cell * row.f[b]);
                const double apart = row.f[b] * std::hypot(share.cell, share.patch, share.state);
                const double systematic = cells.uSystematic[cell];
                row.uSystematic[b] =
                    std::sqrt(std::max(0.0, systematic * systematic - apart * apart));
            }
        }
    }
    return std::move(maker).finished();
}

}  // namespace gonio::proc
