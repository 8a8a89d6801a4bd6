#pragma once
// The merge against the plain Poisson sum [Hanji2020] of the same samples, x = sum e / sum tau. The
// sum knows nothing of the noise model, so that the two agree says that weights from it do not bias
// the result. As the weighted mean has the smallest variance that there is, their difference has
// the variance of the sum less that of the mean.

#include "proc/radiance/merge.h"
#include "proc/radiance/merge_accumulator.h"

namespace gonio::proc {

/// Over all pixels with a usable sample, in electrons: each pixel's light times the effective time
/// that it was seen for.
struct PoissonCheck {
    double electrons = 0;   ///< that the Poisson sum counts
    double difference = 0;  ///< of the merge's from it
    double u = 0;           ///< of the difference, from the noise alone
};

/// `state` is the merge of the sums.
[[nodiscard]] PoissonCheck poissonCheck(const BracketSums& sums, const MergedState& state);

/// The Poisson sum itself, electrons per second; NaN where nothing is usable.
[[nodiscard]] Image<float> poissonSum(const BracketSums& sums);

}  // namespace gonio::proc
