#pragma once
// How a measured sample was calibrated, as tables of a report.

#include "proc/report/html_page.h"
#include "proc/report/report_origin.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

/// Which calibrations, how old, how warm; without rows where the origin has none.
[[nodiscard]] HtmlTable calibrationTable(const SampleSet& sample, const ReportOrigin& origin);
/// Certificates, checks and what may have drifted.
[[nodiscard]] Facts calibrationFacts(const SampleSet& sample);

}  // namespace gonio::proc
