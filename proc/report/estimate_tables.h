#pragma once
// How answers between and beyond the measured angles come about (proc/estimate/sample_estimator.h),
// as tables of a report.

#include <cstddef>
#include <string>
#include <vector>

#include "proc/estimate/sample_estimator.h"
#include "proc/report/html_page.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

/// A row for each method that was asked, the best first: what it errs where parts of the sample are
/// left out, and whether it was chosen. Without rows where nothing could be left out.
[[nodiscard]] HtmlTable methodTable(const MethodChoice& choice);
/// One sentence.
[[nodiscard]] std::string methodSentence(const MethodChoice& choice);
/// Whether the sample is like the prior's library, by band.
[[nodiscard]] std::string priorSentence(const SamplePrior* prior);

/// Incidences to ask at that were not measured: the middles between the sample's, and one 10
/// degrees beyond the last, where that is below 85 degrees.
[[nodiscard]] std::vector<Radians> unmeasuredIncidences(const SampleSet& sample);

/// By incidence: shares of the hemisphere's solid angle by where the answers come from, and the
/// median relative u. `every`: every so-manieth cell is asked.
[[nodiscard]] HtmlTable sourceTable(const SampleSet& sample,
                                    const Scatterer& estimator,
                                    std::size_t every = 16);

}  // namespace gonio::proc
