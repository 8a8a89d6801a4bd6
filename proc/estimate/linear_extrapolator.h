#pragma once
// Beyond the edge linear in theta, from the value at the edge to 0 at 90 degrees [Cezner2023, 4.1.3
// item 2]. That f falls to 0 at grazing angles is the instrument's choice and not physics: f cos
// does, f need not.

#include "proc/estimate/extrapolator.h"

namespace gonio::proc {

/// A Usage error for an edge outside [0, 90) degrees.
[[nodiscard]] Result<std::unique_ptr<Scatterer>> makeLinearExtrapolator(
    std::unique_ptr<Scatterer> inner, const Beyond& beyond = {});

}  // namespace gonio::proc
