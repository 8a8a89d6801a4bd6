#pragma once
// What a measured sample is, what its checks said and what is missing of it, as tables of a report.

#include "proc/quality/verdict.h"
#include "proc/report/html_page.h"
#include "proc/report/report_origin.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

[[nodiscard]] Facts identityFacts(const SampleSet& sample, const ReportOrigin& origin);

/// What else the file carries, by its own names; numbers of more digits are cut to four.
[[nodiscard]] Facts furtherFacts(const SampleSet& sample);

/// A verdict's figure with U (k = 2) where its u is known; empty where it has none.
[[nodiscard]] std::string figureText(const Verdict& verdict);
/// A row for each verdict: grade, figure, limit, evidence, cure.
[[nodiscard]] HtmlTable verdictTable(const SampleSet& sample);

/// By state, shares of the hemisphere's solid angle: measured, missing, and each flag that any cell
/// has.
[[nodiscard]] HtmlTable coverageTable(const SampleSet& sample);

}  // namespace gonio::proc
