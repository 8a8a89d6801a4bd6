#pragma once
// What is asked of one state's cells: which of them count, and the information that each of their
// pixels must give. A cell of N independent pixels and signal S is known to u relative when each
// pixel gives the information 1 / (N (u S)^2).

#include <functional>
#include <span>

#include "proc/plan/cover.h"
#include "proc/plan/plan.h"
#include "proc/plan/systematic_floor.h"

namespace gonio::proc {

/// What may be asked of each kind of shot.
struct Means {
    std::vector<ShotOption> options;  ///< with the least noise that dark frames can leave
    int maxFrames = 256;
    double brightest = 0;  ///< electrons per second that no option reaches beyond

    [[nodiscard]] static Means of(std::vector<ShotOption> options, int maxFrames);
    /// The most that maxFrames of one shot tell about a pixel.
    [[nodiscard]] double mostInformation(double rate) const;
};

/// How a cell enters: in range and wanted to `relative`, or why not.
struct CellDemand {
    enum class Kind {
        Planned,
        BelowRange,
        Saturated,
        NoSignal,
        Ignored
    };
    Kind kind = Kind::Ignored;
    double relative = 0;          ///< after the stop rule
    bool heldAtTheFloor = false;  ///< which is more than the goal wants
};
/// `wanted`: relative. A cell that counts 0 is Ignored too.
[[nodiscard]] CellDemand demandOf(const PlanCell& cell,
                                  const PlanGoal& goal,
                                  double wanted,
                                  const SystematicFloor& floor,
                                  double brightest);

/// All that is needed of one state, and what cannot be had.
struct StateDemands {
    std::vector<CoverNeed> needs;
    std::vector<UnreachedCell> unreached;
    CellCounts counts;
};
[[nodiscard]] StateDemands demandsOf(const StatePilot& state,
                                     const std::function<CellDemand(const PlanCell&)>& demand,
                                     const Means& means);

/// Needs whose rates are alike, within 3 %, as one that implies them all: at most 1.5 % of an
/// uncertainty are given away. The bins do not depend on what is wanted,
/// and none asks for more than `means` can give.
[[nodiscard]] std::vector<CoverNeed> binnedNeeds(const std::vector<CoverNeed>& needs,
                                                 const Means& means);

/// The two counted together.
[[nodiscard]] CellCounts operator+(const CellCounts& a, const CellCounts& b);

}  // namespace gonio::proc
