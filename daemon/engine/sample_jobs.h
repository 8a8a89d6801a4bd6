#pragma once
// The jobs about samples: what measuring one would take, and measuring it.

#include "daemon/engine/job_run.h"

namespace gonio::daemon {

/// Each leaves a document. Quality error for calibrations that are no longer good, and for a bad
/// sample, which is kept aside as NAME.refused.
[[nodiscard]] Result<nlohmann::ordered_json> measure(const JobRun& run);
[[nodiscard]] Result<nlohmann::ordered_json> plan(const JobRun& run);

}  // namespace gonio::daemon
