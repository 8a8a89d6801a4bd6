#pragma once
// Takes the frames of whole measurements: dark ladders, brackets of one state, all states of a
// placement. A bracket starts at an exposure that is safe for white, goes to shorter exposures and
// dimmer LEDs while anything is saturated, and to longer ones until everything is. Each capture has
// a plan step of its own, so that no two share their noise.

#include <cstdint>
#include <functional>
#include <vector>

#include "daemon/profile.h"
#include "driver/rig.h"
#include "proc/core/effort.h"
#include "proc/radiance/dark.h"
#include "proc/radiance/merge.h"

namespace gonio::daemon {

/// How many frames a bracket takes of each exposure, and how far it reaches.
struct BracketPlan {
    int frames = 1;
    bool dim = true;   ///< use dimmer LED levels where the shortest exposure saturates
    int longest = -1;  ///< index of the longest exposure of the ladder; -1: the last
    int first = 1;     ///< index of the exposure to begin with
};

/// The bracket that an effort asks for of a sample.
[[nodiscard]] BracketPlan sampleBracket(Effort effort);

struct State {
    int led = 0;
    Band band = Band::R;
};

class Sequencer {
public:
    /// `rig` must be configured; it, the profile and the counter must outlive the sequencer.
    Sequencer(driver::Rig& rig, const RigProfile& profile, std::uint64_t& nextPlanStep);

    /// LEDs x R, G, B, in this order.
    [[nodiscard]] std::vector<State> states() const;
    /// All frames of one state's bracket.
    [[nodiscard]] Result<std::vector<Frame>> bracket(State state, const BracketPlan& plan);
    /// `frames` of one level and exposure.
    [[nodiscard]] Result<std::vector<Frame>> expose(State state,
                                                    double level,
                                                    Microseconds exposure,
                                                    int frames);
    /// Mean dark frames for the whole ladder of exposures; `done` is called after each, and an
    /// error that it returns ends the ladder.
    [[nodiscard]] Result<std::vector<proc::DarkFrame>> darks(
        int frames, const std::function<Result<void>()>& done);

private:
    driver::Rig& rig_;
    const RigProfile& profile_;
    std::uint64_t& nextPlanStep_;
    int leds_;
};

}  // namespace gonio::daemon
