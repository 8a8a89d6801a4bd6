#pragma once
// What a measured sample achieved.

#include <optional>

#include "proc/table/sample_set.h"

namespace gonio::proc {

/// The median of u / f over the cells present with f above 0, k = 1; empty: there are none.
[[nodiscard]] std::optional<double> achievedUncertainty(const SampleSet& set);

}  // namespace gonio::proc
