#pragma once
// The jobs about what samples are held against: lens map, black, white, light trap, and the check
// of the white.

#include "daemon/engine/job_run.h"

namespace gonio::daemon {

/// Each leaves a document. Quality error for what is no good, or lies not under the rig.
[[nodiscard]] Result<nlohmann::ordered_json> calibrateMirror(const JobRun& run);
/// `kind`: black, white or zero.
[[nodiscard]] Result<nlohmann::ordered_json> calibrateTile(const JobRun& run,
                                                           const std::string& kind);
/// The flat field, from the white reference.
[[nodiscard]] Result<nlohmann::ordered_json> calibrateFlat(const JobRun& run);
/// How far the white is from what it was; turned about its normal, how far from itself.
[[nodiscard]] Result<nlohmann::ordered_json> verifyWhite(const JobRun& run);

}  // namespace gonio::daemon
