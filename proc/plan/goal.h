#pragma once
// What a run is planned for: a wanted relative random uncertainty of every cell with f >= fMin, or
// a time in which it shall be as small as can be.
//
// The stop rule. Random uncertainty well below the systematic one buys nothing: at a third of it
// the total is within 5.5 % of the floor. So no cell is given a smaller one than `floorShare` times
// its systematic uncertainty, unless `beyondFloor` is set; a plan says how many cells that held
// back. The floor does not depend on what is wanted, so a stricter goal still costs no less.

#include <optional>

#include "proc/core/effort.h"
#include "proc/core/result.h"
#include "proc/core/units.h"

namespace gonio::proc {

struct PlanGoal {
    /// Relative, k = 1, of each cell's mean; exactly one of this and `budget` is set.
    std::optional<double> wanted{};
    std::optional<Seconds> budget{};  ///< on the rig, all told
    double fMin = 1e-3;               ///< 1/sr; dimmer cells are measured, but nothing is asked
    double floorShare = 1.0 / 3;
    bool beyondFloor = false;
    /// Pilot frames count as data. False: they are thrown away after the estimate.
    bool pilotsAreData = true;

    /// draft 10 %, standard 1 %, reference 0.3 % (which promises 0.45 %).
    [[nodiscard]] static PlanGoal of(Effort effort);
    [[nodiscard]] static PlanGoal within(Seconds budget);
    /// Usage error that says which value is out of its domain.
    [[nodiscard]] Result<void> check() const;
};

/// The random uncertainty that an effort promises: relative, k = 1.
[[nodiscard]] double promisedUncertainty(Effort effort);

}  // namespace gonio::proc
