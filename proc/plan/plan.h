#pragma once
// A plan: the captures of a whole run, what they take and what they will achieve (planner.h says
// how it is found). Uncertainties are relative and k = 1. Random: the noise of the sample's frames
// and of its dark frames. Systematic: the floor at the cell's f. Total: both in quadrature.
// Cramer-Rao: the random part of the same frames, were the dark frames without noise.

#include <string>
#include <vector>

#include "proc/plan/goal.h"
#include "proc/plan/pilot.h"
#include "proc/plan/rig_model.h"

namespace gonio::proc {

struct PlannedCapture {
    ShotKind shot;
    int frames = 0;
    bool operator==(const PlannedCapture&) const = default;
};

struct DarkCapture {
    Seconds exposure{0};
    int frames = 0;
    bool operator==(const DarkCapture&) const = default;
};

/// Where the seconds go; each second is in one part.
struct TimeParts {
    Seconds exposure{0};  ///< light that falls on the sensor, pilots excepted
    Seconds readout{0};   ///< waiting for the frame period, and the last transfer
    Seconds settle{0};    ///< of LEDs, where no frame period hides it
    Seconds dark{0};      ///< dark frames
    Seconds pilot{0};     ///< pilot frames, and those that are repeated at the end
    Seconds latency{0};   ///< hand-overs that nothing hides, and waiting for the plan

    [[nodiscard]] Seconds total() const {
        return exposure + readout + settle + dark + pilot + latency;
    }
};

/// Over cells, by count. NaN of no cell.
struct Spread {
    double worst = 0;
    double percentile95 = 0;
    double median = 0;
};

/// Relative uncertainties, k = 1, of the cells in range that can be measured.
struct Prediction {
    Spread random, systematic, total;
    Spread cramerRao;
    std::size_t cells = 0;
};

struct StatePlan {
    int led = 0;
    Band band = Band::R;
    std::vector<PlannedCapture> captures;  ///< in this order, after the pilots
};

enum class Shortcoming {
    Saturated,  ///< at the shortest exposure and the dimmest level
    TooDim,     ///< the wanted uncertainty takes more than a capture's frames
    NoSignal,   ///< no light of its own, though f >= fMin
};

struct UnreachedCell {
    std::size_t state = 0;  ///< of the plan
    std::size_t cell = 0;   ///< of the state's pilot
    Shortcoming why = Shortcoming::Saturated;
};

/// By cell, each counted `count` times.
struct CellCounts {
    std::size_t planned = 0;     ///< in range; what the prediction is over
    std::size_t belowRange = 0;  ///< f < fMin
    std::size_t saturated = 0;
    std::size_t tooDim = 0;  ///< planned all the same, to what they can be given
    std::size_t noSignal = 0;
    std::size_t ignored = 0;         ///< NaN
    std::size_t heldAtTheFloor = 0;  ///< given less than wanted by the stop rule
};

struct Plan {
    PlanGoal goal;
    double wanted = 0;               ///< relative random, k = 1: what it was made for
    std::vector<ShotKind> pilots;    ///< one frame of each in every state, first
    std::vector<DarkCapture> darks;  ///< after the pilots; the pilots' exposures first
    std::vector<StatePlan> states;   ///< in the order of the pilots
    int darkFrames = 0;              ///< that each mean dark frame is made of
    bool proven = true;              ///< that no plan is cheaper (cover.h)
    TimeParts seconds;
    Prediction predicted;
    CellCounts counts;
    std::vector<UnreachedCell> unreached;
    /// The least time by the Cramer-Rao bound: fractions of frames, no pilots, dark frames,
    /// settling or waiting (cover_bound.h).
    Seconds cramerRao{0};
    /// What a reader should know: the stop rule's part, cells that cannot reach the goal.
    std::vector<std::string> notes;

    [[nodiscard]] int framesOf(std::size_t state) const;  ///< pilots excepted
};

}  // namespace gonio::proc
