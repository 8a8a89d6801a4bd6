#include "proc/plan/trade_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

constexpr std::array<double, 4> kLedDegrees{0, 20, 40, 60};
constexpr std::array<double, 4> kLedFactor{1, 0.95, 0.9, 0.85};
constexpr std::array<double, 3> kBandFactor{0.8, 1.0, 0.7};
constexpr std::array<double, 3> kLevels{1, 1.0 / 20, 1.0 / 400};
constexpr int kVisibleRows = 75;

/// The centre of the cell that holds the mirror direction of an LED.
Direction mirrorCell(double incidenceDegrees) {
    const Direction mirror =
        Direction::fromSpherical(Radians::fromDegrees(incidenceDegrees), Radians(kPi));
    return CellGrid::centre(*CellGrid::cellAt(mirror));
}

struct CellView {
    double cosine = 0;
    double pixels = 0;
    double throughput = 0;  ///< of one pixel, relative to the middle of the field
};

CellView viewOf(std::size_t cell, const PhotonBudget& budget) {
    const Direction centre = CellGrid::centre(cell);
    const CellBounds bounds = CellGrid::bounds(cell);
    const double low = bounds.thetaLow.degrees();
    const double high = bounds.thetaHigh.degrees();
    const double sector = (bounds.phiHigh - bounds.phiLow).value();
    const double theta = centre.theta().value();
    const double rim = theta / Radians::fromDegrees(kVisibleRows).value();
    const double scale = budget.pixelsPerDegree * budget.pixelsPerDegree;
    return {.cosine = centre.z(),
            .pixels = scale * (high * high - low * low) / 2 * sector,
            .throughput = std::sin(theta) / theta * (1 - budget.falloff * rim * rim)};
}

}  // namespace

double TradeMaterial::f(Radians fromMirror) const {
    const double d = fromMirror.value() / width.value();
    const double fall = 1 + d * d;
    return base + (peak - base) / (fall * fall);
}

const std::vector<TradeMaterial>& tradeMaterials() {
    static const std::vector<TradeMaterial> materials{
        {.name = "white", .base = 0.98 / kPi, .peak = 0.98 / kPi, .width = 10_deg},
        {.name = "satin", .base = 0.02, .peak = 3, .width = 10_deg},
        {.name = "gloss black", .base = 1e-3, .peak = 170, .width = 1.2_deg},
        {.name = "gloss metal", .base = 1e-3, .peak = 4170, .width = 0.7_deg},
    };
    return materials;
}

LevelChoice levelChoice(int levels) {
    const auto count = static_cast<std::size_t>(std::clamp(levels, 1, int{kLevels.size()}));
    LevelChoice choice;
    choice.levels.assign(kLevels.begin(), kLevels.begin() + static_cast<std::ptrdiff_t>(count));
    choice.budget.ratePerSr *= kLevels.back() / choice.levels.back();
    return choice;
}

std::vector<StatePilot> tradeStates(const TradeMaterial& material, const PhotonBudget& budget) {
    std::vector<StatePilot> states;
    const std::size_t cells = CellGrid::index({.row = kVisibleRows, .sector = 0});
    for (std::size_t led = 0; led < kLedDegrees.size(); ++led) {
        const Direction mirror = mirrorCell(kLedDegrees[led]);
        for (const Band band : kBands) {
            const double rate = budget.ratePerSr * kLedFactor[led] * kBandFactor[index(band)];
            StatePilot state{.led = static_cast<int>(led), .band = band};
            for (std::size_t i = 0; i < cells; ++i) {
                const CellView view = viewOf(i, budget);
                const double f =
                    material.f(angleBetween({.in = mirror, .out = CellGrid::centre(i)}));
                const double perPixel = rate * view.throughput;
                state.cells.push_back({.f = f,
                                       .rate = perPixel * (f * view.cosine + budget.stray),
                                       .pixels = view.pixels,
                                       .background = perPixel * budget.stray});
            }
            states.push_back(std::move(state));
        }
    }
    return states;
}

RigModel tradeRig(const RigTiming& timing, const std::vector<double>& levels) {
    RigModel rig{.timing = timing, .levels = levels};
    for (const double us : {20.0, 80.0, 320.0, 1280.0, 5120.0, 40e3})
        rig.exposures.emplace_back(us * 1e-6);
    if (levels.size() < kLevels.size()) {
        for (const double us : {200e3, 1e6}) rig.exposures.emplace_back(us * 1e-6);
    }
    return rig;
}

}  // namespace gonio::proc
