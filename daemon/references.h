#pragma once
// The certified references that a rig profile names: the tabulated white, the uniform black,
// and the light trap whose f is 0.

#include <memory>

#include "daemon/profile.h"
#include "proc/calibrate/reference.h"

namespace gonio::daemon {

struct References {
    std::shared_ptr<const proc::ReferenceTable> white;  ///< shared with the simulated rig's stage
    std::shared_ptr<const proc::ReferenceTable> black;
    std::shared_ptr<const proc::ReferenceTable> zero;
};

[[nodiscard]] Result<References> loadReferences(const RigProfile& profile);
/// Of the default profile.
[[nodiscard]] Result<References> loadReferences();

}  // namespace gonio::daemon
