#pragma once
// A HalfDifferenceTable made by asking a Scatterer at each node, the half vector at azimuth 0: the
// way from anything that answers to a MERL file. What is not isotropic is asked for that azimuth
// alone. A node without an answer, or with a direction below the horizon, is NaN.

#include <cstddef>

#include "proc/core/scatterer.h"
#include "proc/table/half_difference_table.h"

namespace gonio::proc {

struct FilledHalfDifference {
    HalfDifferenceTable table;
    std::size_t nodes = 0;         ///< with both directions above the horizon
    std::size_t unanswered = 0;    ///< of these, without an answer: NaN in the table
    std::size_t uncertain = 0;     ///< answered with an uncertainty, which the table cannot hold
    std::size_t extrapolated = 0;  ///< answered from beyond what was measured
};

/// MERL's own grid: 90 x 90 x 180.
[[nodiscard]] FilledHalfDifference fillHalfDifference(const Scatterer& from);
/// On the axes of `grid`, whose planes are not looked at.
[[nodiscard]] FilledHalfDifference fillHalfDifference(const Scatterer& from,
                                                      HalfDifferenceTable grid);

}  // namespace gonio::proc
