#pragma once
// The jobs that take what samples are held against: lens map, black, white, light trap, flat field.

#include "daemon/engine/job_run.h"

namespace gonio::daemon {

/// Each leaves a document. Quality error for what is no good, or lies not under the rig.
[[nodiscard]] Result<nlohmann::ordered_json> calibrateMirror(const JobRun& run);
/// `kind`: black, white or zero.
[[nodiscard]] Result<nlohmann::ordered_json> calibrateTile(const JobRun& run,
                                                           const std::string& kind);
/// The flat field, from the white reference.
[[nodiscard]] Result<nlohmann::ordered_json> calibrateFlat(const JobRun& run);

}  // namespace gonio::daemon
