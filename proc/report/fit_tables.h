#pragma once
// Models fitted to a sample (proc/fit/selection.h) as tables of a report.

#include "proc/fit/selection.h"
#include "proc/report/html_page.h"

namespace gonio::proc {

/// A row for each family, the best first: parameters, misfit, errors of what was held out, and
/// whether it was chosen, possible, rejected, or why it failed.
[[nodiscard]] HtmlTable fitTable(const Selection& selection);
/// Values of the usable fits' parameters with U (k = 2); what a bound holds says so.
[[nodiscard]] HtmlTable parameterTable(const Selection& selection);
/// Where the best fit misses most, six regions at most.
[[nodiscard]] HtmlTable misfitTable(const Selection& selection);

}  // namespace gonio::proc
