#pragma once
// Rigs and scenes small enough to plan in milliseconds.

#include <cmath>
#include <cstddef>
#include <vector>

#include "proc/plan/planner.h"
#include "proc/plan/trade_scene.h"

namespace gonio::test {

inline constexpr double kPixelsPerCell = 44;

/// One state whose cells run evenly over the logarithm of f, from base to peak.
inline proc::StatePilot ladderOfCells(const proc::TradeMaterial& material,
                                      const proc::PhotonBudget& budget,
                                      int cells) {
    proc::StatePilot state;
    for (int i = 0; i < cells; ++i) {
        const double f = material.base * std::pow(material.peak / material.base,
                                                  cells == 1 ? 0 : i / (cells - 1.0));
        state.cells.push_back({.f = f, .rate = f * budget.ratePerSr, .pixels = kPixelsPerCell});
    }
    return state;
}

struct SmallScene {
    proc::RigModel rig;
    std::vector<proc::StatePilot> states;
    proc::SystematicFloor floor = proc::SystematicFloor::typical(proc::Zero::ZeroReference);

    [[nodiscard]] proc::PlanInput input() const { return {rig, states, floor}; }
};

/// Gloss metal on a USB 2 rig with three levels unless said otherwise.
inline SmallScene smallScene(std::size_t material = 3,
                             int levels = 3,
                             const proc::RigTiming& timing = proc::RigTiming::usb2(),
                             int cells = 120) {
    const proc::LevelChoice choice = proc::levelChoice(levels);
    return {.rig = proc::tradeRig(timing, choice.levels),
            .states = {ladderOfCells(proc::tradeMaterials()[material], choice.budget, cells)}};
}

}  // namespace gonio::test
