#pragma once
// How much light a sample sends back, and whether it does so both ways alike, as tables of a
// report. Values have U (k = 2) behind them.

#include "proc/core/scatterer.h"
#include "proc/report/html_page.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

/// Directional-hemispherical reflectance over the measured cells (sample_albedo.h), by incidence
/// and rotation, and the mean over the incidences with what the line between them may be off by
/// ("line within"): that is no lower bound.
[[nodiscard]] HtmlTable cellAlbedoTable(const SampleSet& sample);

/// The same with what is missing filled in by the answers of `surface`.
[[nodiscard]] HtmlTable filledAlbedoTable(const SampleSet& sample, const Scatterer& surface);

/// f(a -> b) against f(b -> a) for each two LEDs of a rotation and side, by band
/// (proc/quality/reciprocity.h).
/// Without rows where no pair was measured both ways.
[[nodiscard]] HtmlTable reciprocityTable(const SampleSet& sample);

}  // namespace gonio::proc
