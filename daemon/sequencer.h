#pragma once
// Takes the frames of whole measurements: dark ladders, brackets of one state (bracket_ladder.h),
// all states of a placement. The next capture is armed ahead where it is known or foreseen, so that
// exposures overlap transfers. Each capture has a plan step of its own, so that no two share their
// noise, and the same placement always makes the same captures.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/bracket_ladder.h"
#include "daemon/profile.h"
#include "driver/rig.h"
#include "proc/core/effort.h"
#include "proc/radiance/dark.h"

namespace gonio::daemon {

/// The bracket that an effort asks for of a sample.
[[nodiscard]] BracketPlan sampleBracket(Effort effort);

struct State {
    int led = 0;
    Band band = Band::R;
};

/// "LED 2 g".
[[nodiscard]] std::string stateName(State state);

class Sequencer {
public:
    /// `rig` must be configured; it, the profile and the counter must outlive the sequencer.
    /// `alive` is called before each capture.
    Sequencer(
        driver::Rig& rig,
        const RigProfile& profile,
        std::uint64_t& nextPlanStep,
        std::function<void()> alive = [] {});

    /// LEDs x R, G, B, in this order.
    [[nodiscard]] std::vector<State> states() const;
    /// All frames of one state's bracket. The first capture of `then`, if its bracket comes next
    /// and by the same plan, is armed ahead with the last of this one.
    [[nodiscard]] Result<std::vector<Frame>> bracket(State state,
                                                     const BracketPlan& plan,
                                                     std::optional<State> then = {});
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
    [[nodiscard]] driver::CaptureRequest numbered(driver::CaptureRequest request);
    [[nodiscard]] driver::CaptureRequest begin(driver::CaptureRequest first);
    [[nodiscard]] driver::CaptureRequest prepare(State state, const BracketPlan& plan);
    [[nodiscard]] Result<driver::Capture> take(const driver::CaptureRequest& request,
                                               const driver::ArmAhead& ahead = {});

    driver::Rig& rig_;
    const RigProfile& profile_;
    std::uint64_t& nextPlanStep_;
    std::function<void()> alive_;
    int leds_;
    std::optional<driver::CaptureRequest> prepared_;  ///< the next bracket's first
};

}  // namespace gonio::daemon
