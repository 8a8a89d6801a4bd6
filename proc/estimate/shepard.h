#pragma once
// Shepard's interpolation [Shepard1968] among the nearest samples of a scattered set, as in
// [Cezner2023, eq. 37 and 38]. With d_i the distances of pair_distance.h,
//
//     epsilon = 0:  f = f_i where d_i = 0, else  sum f_i d_i^-2 / sum d_i^-2      (eq. 37)
//     epsilon > 0:  f = sum f_i (d_i + epsilon)^-2 / sum (d_i + epsilon)^-2       (eq. 38)
//
// over the `most` nearest that are at most `maxDistance` away. Fewer than `fewest` of them: no
// answer, where the thesis says 0. It searches a distance smaller than the maximum, ours takes the
// maximum in.
//
// At a sample (d < 1e-9, rounding of angles), epsilon = 0: source measured; several samples at the
// same pair give their mean. Everything else is interpolated, with epsilon > 0 at a sample too: the
// others weigh in. Beyond the data the nearest samples still answer, until the distance ends it.

#include <memory>

#include "proc/core/result.h"
#include "proc/table/scattered_set.h"

namespace gonio::proc {

struct ShepardOptions {
    std::size_t fewest = 1;
    std::size_t most = 10;
    double maxDistance = 0.4;  ///< 23 degrees: reaches over half of a gap of 20 degrees
    double epsilon = 0;
};

/// A Usage error for options out of their domain: 1 <= fewest <= most, maxDistance > 0 (infinity
/// allowed), epsilon >= 0 and finite.
[[nodiscard]] Result<std::unique_ptr<Scatterer>> makeShepard(ScatteredSet data,
                                                             const ShepardOptions& options = {});

}  // namespace gonio::proc
