#pragma once
// How far a measured sample of the simulated rig is from the truth. The truth of a cell is the mean
// of the truth over its solid angle. Counted are measured cells whose truth is known all over the
// cell, is at least 1e-2 1/sr, and is not on a lobe flank steeper than 20 % per degree.

#include "proc/core/scatterer.h"
#include "proc/table/sample_set.h"

namespace gonio::daemon {

struct Score {
    int cells = 0;                   ///< counted, over all LEDs and bands
    double medianRelativeError = 0;  ///< of |f - truth| / truth
    double p95RelativeError = 0;
    double within2u = 0;        ///< share of cells with |f - truth| <= 2 u
    double within2uRandom = 0;  ///< the same with the random part alone
};

/// Cells count alike: they are all about one square degree.
[[nodiscard]] Score score(const proc::SampleSet& measured, const Scatterer& truth);

}  // namespace gonio::daemon
