#pragma once
// No answer beyond the edge [Cezner2023, 4.1.3 item 1]. The thesis and the instrument say 0 there;
// missing is never 0 here.

#include "proc/estimate/extrapolator.h"

namespace gonio::proc {

/// A Usage error for an edge outside [0, 90) degrees.
[[nodiscard]] Result<std::unique_ptr<Scatterer>> makeNoExtrapolation(
    std::unique_ptr<Scatterer> inner, const Beyond& beyond = {});

}  // namespace gonio::proc
