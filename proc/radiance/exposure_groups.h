#pragma once
// The frames of a bracket that were taken alike: same granted exposure, same LED level. They share
// an effective time and a dark frame, and so a weight.

#include <span>
#include <vector>

#include "proc/core/bands.h"
#include "proc/core/frame.h"
#include "proc/core/result.h"
#include "proc/radiance/dark.h"

namespace gonio::proc {

struct ExposureGroup {
    std::vector<const Frame*> frames;
    const DarkFrame* dark = nullptr;
    double seconds = 0;  ///< t
    double tau = 0;      ///< t L / 65535
};

/// What all frames of one bracket have in common.
struct BracketTraits {
    int led = 0;
    Window window;
    Size size;
    double gainDb = 0;
};

/// Of a bracket's first frame. Quality error when it has no pixels, or is not lit in `band` alone.
[[nodiscard]] Result<BracketTraits> traitsOf(const Frame& first, Band band);
/// Quality error that says why the frame is not one of the bracket.
[[nodiscard]] Result<void> checkBelongs(const Frame& frame,
                                        const BracketTraits& bracket,
                                        Band band);

/// t L / 65535 of a frame lit in `band`.
[[nodiscard]] double effectiveSeconds(const Frame& frame, Band band);

/// Checks that the bracket is one state, and sorts it into groups. The groups borrow from `bracket`
/// and `darks`.
[[nodiscard]] Result<std::vector<ExposureGroup>> exposureGroups(std::span<const Frame> bracket,
                                                                Band band,
                                                                const DarkLibrary& darks);

}  // namespace gonio::proc
