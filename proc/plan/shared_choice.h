#pragma once
// What all states of a run share: which exposures are used, since each needs dark frames, and how
// many of them. Tries every set of exposures that holds the pilots', with every number of dark
// frames, and drops those that cannot be the cheapest: what a set costs at least is known from its
// dark frames and the bounds of its states (cover_bound.h).

#include <optional>
#include <vector>

#include "proc/plan/cover.h"
#include "proc/plan/rig_model.h"

namespace gonio::proc {

/// Numbers of frames that a mean dark frame may be made of.
inline constexpr int kDarkChoices[] = {1, 2, 4, 8, 16, 32, 64};

/// Levels with exposures, levels first. A dimmed LED is there for what saturates the shortest
/// exposure at the level above: longer effective times are left to that level, in less time.
[[nodiscard]] std::vector<ShotOption> shotOptions(const RigModel& rig, int darkFrames);

struct SharedChoice {
    int darkFrames = 1;          ///< of each mean dark frame
    std::vector<Seconds> darks;  ///< exposures, the pilots' first; none when a library holds them
    std::vector<ShotOption> options;
    std::vector<int> have;               ///< pilot frames of each option
    std::vector<std::vector<int>> more;  ///< of each state, of each option
    Nanoseconds cost{0};                 ///< all that depends on the choice
    bool proven = true;                  ///< that no choice is cheaper (cover.h)
};

struct SharedProblem {
    const RigModel& rig;
    bool pilotsAreData = true;
    const std::vector<std::vector<CoverNeed>>& needs;  ///< of each state
};

/// Nothing when the needs cannot be met (Means::mostInformation says what can).
[[nodiscard]] std::optional<SharedChoice> cheapestChoice(const SharedProblem& problem);

/// What the run waits for its plan: nothing, where the dark frames of the pilots' exposures take as
/// long.
[[nodiscard]] Nanoseconds waitForPlan(const RigModel& rig, int darkFrames);

/// The pilots' exposures, each once.
[[nodiscard]] std::vector<Seconds> pilotExposures(const RigModel& rig);

}  // namespace gonio::proc
