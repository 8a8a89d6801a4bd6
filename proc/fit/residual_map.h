#pragma once
// Residuals of a fit over the cells of each incidence, (f - model) / u per band: a sample whose f
// is that number, so that whatever shows or writes a sample shows and writes them. Scattered pairs
// fall into the cell of their view, the light's azimuth turned to 0, and are averaged there. A cell
// without values is missing.

#include "proc/fit/model_fit.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

[[nodiscard]] SampleSet residualMap(const ModelFit& fit, const BrdfData& data);
/// The same without signs, for colours on a logarithmic scale.
[[nodiscard]] SampleSet residualSizeMap(const ModelFit& fit, const BrdfData& data);

/// Root mean square of the residuals of each incidence and band; NaN where there is none.
[[nodiscard]] std::vector<std::array<double, 3>> residualRms(const ModelFit& fit,
                                                             const BrdfData& data);

}  // namespace gonio::proc
