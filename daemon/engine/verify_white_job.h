#pragma once
// The job that checks the white reference: how far it is from what it was when it was calibrated;
// turned about its normal, how far from itself.

#include "daemon/engine/job_run.h"

namespace gonio::daemon {

/// Leaves a document. Quality error for a white that is no good, or lies not under the rig.
[[nodiscard]] Result<nlohmann::ordered_json> verifyWhite(const JobRun& run);

}  // namespace gonio::daemon
