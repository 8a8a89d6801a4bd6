#pragma once
// What lies under the rig, and what is wrong with everything around it.

#include <cstdint>
#include <memory>

#include "proc/core/scatterer.h"
#include "sim/pose.h"
#include "sim/reference_errors.h"
#include "sim/rig_errors.h"
#include "sim/sample_errors.h"

namespace gonio::sim {

enum class Role {
    Nothing,
    Sample,
    White,
    Black,
    Zero,  ///< a light trap: no surface, only what is left of its f
    Mirror
};

struct Placement {
    Role role = Role::Nothing;
    std::shared_ptr<const Scatterer>
        surface;       ///< of Sample, White, Black; shared with the host's truth
    Wedge wedge;       ///< of Sample and Mirror: the references lie flat
    Radians turned{};  ///< of Sample and White, about its normal; a white's errors turn with it
    SampleErrors errors{};  ///< of Sample; the ambient light of whatever is placed
};

/// Of the rig and its reference tiles. The seed draws what is drawn of the light.
struct Flaws {
    ReferenceErrors references{};
    RigErrors rig{};
    std::uint64_t seed = 1;
};

}  // namespace gonio::sim
