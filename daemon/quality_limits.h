#pragma once
// Where the verdicts on a sample draw their lines, from a file: config/quality/*.toml.

#include <filesystem>
#include <string>

#include "proc/core/result.h"
#include "proc/core/units.h"
#include "proc/quality/limits.h"

namespace gonio::daemon {

/// How a sample may lie (sample_pose.h).
struct PoseLimits {
    Radians corrected = 0.05_deg;  ///< and three standard uncertainties: smaller ones are let be
    Radians warned = 1_deg;
    Radians refused = 5_deg;  ///< the model of a tilt holds no longer
    Radians wavy = 0.2_deg;   ///< root mean square between the LEDs' normals
    double matt = 0.5;  ///< alpha: a wider lobe shows its tilt badly, and hardly suffers from it
};

struct JudgingLimits {
    proc::QualityLimits sample;
    PoseLimits pose;
    double lightStep = 0.03;     ///< within a bracket, relative (light_watch.h)
    std::string name = "usual";  ///< of the file, without its extension
};

/// Keys that the file leaves out keep their usual limits. Errors name the file and the key; so does
/// one that is not known, and a warning that would come behind its refusal.
[[nodiscard]] Result<JudgingLimits> readLimits(const std::filesystem::path& file);

}  // namespace gonio::daemon
