#pragma once
// What was lost because no exposure was short enough, no LED dim enough: the share of the measured
// field (rows of cells that any state measured) whose cells are Saturated, by solid angle, in the
// state that lost most. A lost lobe is a hole where the sample is brightest: any is warned of.

#include "proc/quality/limits.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

/// Of one state: saturated over saturated or measured, by solid angle; 0 when there is neither.
[[nodiscard]] double saturatedShare(const CellSamples& cells);

[[nodiscard]] Verdict saturationVerdict(const SampleSet& sample, const QualityLimits& limits = {});

}  // namespace gonio::proc
