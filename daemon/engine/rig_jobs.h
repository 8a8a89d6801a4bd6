#pragma once
// The jobs about the rig itself, over the white reference: its sensor, its LEDs' warm-up, its dark
// frames.

#include "daemon/engine/job_run.h"

namespace gonio::daemon {

/// Each leaves a document. Quality error for what is no good, or lies not under the rig.
[[nodiscard]] Result<nlohmann::ordered_json> calibrateSensor(const JobRun& run);
[[nodiscard]] Result<nlohmann::ordered_json> calibrateLeds(const JobRun& run);
/// Whatever lies there: the LEDs stay dark.
[[nodiscard]] Result<nlohmann::ordered_json> calibrateDark(const JobRun& run);

}  // namespace gonio::daemon
