#pragma once
// Beyond the edge the value at the edge [Cezner2023, 4.1.3 item 3, and 6.1.3: ClampExtrapolator].

#include "proc/estimate/extrapolator.h"

namespace gonio::proc {

/// A Usage error for an edge outside [0, 90) degrees.
[[nodiscard]] Result<std::unique_ptr<Scatterer>> makeClampExtrapolator(
    std::unique_ptr<Scatterer> inner, const Beyond& beyond = {});

}  // namespace gonio::proc
