#pragma once
// Each frame of a bracket against the others, by the witness pixels that were kept of it: an LED
// whose light steps, a frame that was taken with another exposure than it says, a sample that
// moved.
//
// Per frame: its brightness against what the others say of the same pixels (scale_system.h), and
// chi^2 = the mean over pixels of its squared distance from the mean of all frames there, in units
// of the variance of that distance: 1 where noise alone differs. Frames of one exposure share the
// noise of their dark frame (shared_noise.h). Changed light is looked for as a step (all frames
// from one on are brighter) and as a single frame; the most significant one is reported that is at
// least 5 standard uncertainties, as large as wanted, and beyond what wrong scales of whole
// groups of frames, the wandering zero of each (group_scales.h), and the rounding of binned pixels
// of a group (noise.h) make of it at 95 %: a step between two groups of one frame each looks no
// different from that. By noise alone one in 2e6 of
// these is a false alarm, and of n frames 2 n - 3 are tried.
//
// With one frame, or without a pixel that two frames see, nothing can be said, and nothing is.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "proc/radiance/group_scales.h"
#include "proc/radiance/merge.h"
#include "proc/radiance/merge_accumulator.h"
#include "proc/radiance/scale_system.h"

namespace gonio::proc {

struct FrameResidual {
    std::uint32_t number = 0;                ///< the frame's
    std::optional<BrightnessOffset> offset;  ///< against the others; empty: no pixel in common
    double chiSquare = 0;                    ///< sum over pixels
    std::size_t freedom = 0;                 ///< pixels
};

/// Frames first .. last, as they came, are brighter than the others.
struct LightChange {
    std::size_t first = 0, last = 0;
    BrightnessOffset offset;
    double uNominal = 0;  ///< of the offset, by nominal scales, zeros and rounding
};

struct FrameReport {
    std::vector<FrameResidual> frames;  ///< as they came
    std::optional<LightChange> change;
};

/// `state` is the merge of the sums; changes smaller than `smallest` (relative) are not reported.
[[nodiscard]] FrameReport frameResiduals(const BracketSums& sums,
                                         const MergedState& state,
                                         double smallest = 0.01,
                                         const NominalUncertainty& nominal = {});

}  // namespace gonio::proc
