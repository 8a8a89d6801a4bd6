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

/// Checks that the bracket is one state, and sorts it into groups. The groups borrow from `bracket`
/// and `darks`.
[[nodiscard]] Result<std::vector<ExposureGroup>> exposureGroups(std::span<const Frame> bracket,
                                                                Band band,
                                                                const DarkLibrary& darks);

}  // namespace gonio::proc
