#pragma once
// Whether the light stayed the same while a bracket was taken: each frame against the others
// (proc/radiance/frame_residuals.h). A step between two brackets shows in neither.

#include <optional>
#include <span>
#include <string>

#include "daemon/sequencer.h"
#include "proc/quality/verdict.h"
#include "proc/radiance/frame_residuals.h"

namespace gonio::daemon {

/// Frames of a state that are brighter or darker than its others.
struct LightStep {
    State state;
    proc::LightChange change;
    std::size_t frames = 0;  ///< of the bracket
};

/// `merged` is the merge of the sums. Changes below `smallest` are let be, and what wrong scales
/// explain: an exposure that lasts longer than granted, or a dimmed level that is off, makes all
/// frames of a group brighter, and both are in the calibration too. So does a zero that wanders, in
/// a frame of next to no light.
[[nodiscard]] std::optional<LightStep> lightStep(State state,
                                                 const proc::BracketSums& sums,
                                                 const proc::MergedState& merged,
                                                 double smallest);

/// One sentence part for each, such as "LED 2 g: frames 9 to 16 of 16 are 5.0 % (u 0.1 %) darker
/// than the others"; empty without any.
[[nodiscard]] std::string described(std::span<const LightStep> steps);

/// `light`: refused with any step; its figure is the largest one's, its limit the `smallest`.
[[nodiscard]] proc::Verdict lightVerdict(std::span<const LightStep> steps, double smallest);

}  // namespace gonio::daemon
