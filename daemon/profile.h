#pragma once
// What the host knows of a kind of rig before it asks it: config/rigs/*.toml.

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/quality_limits.h"
#include "proc/core/result.h"
#include "proc/core/units.h"
#include "proc/radiance/linearity.h"
#include "proc/radiance/noise.h"

namespace gonio::daemon {

/// For how long a calibration is good.
struct ValidityLimits {
    Seconds mirror = std::chrono::hours(90 * 24);  ///< age of a lens map
    Seconds tiles = std::chrono::hours(24);        ///< of the references
    double kelvin = 5;                             ///< change of the LED board's temperature
};

struct RigProfile {
    std::string name;
    /// Of the file's bytes without [quality], which no calibration depends on: eight hexadecimal
    /// digits.
    std::string hash;
    int cameraUsb = 2;  ///< the camera's USB, 2 or 3; a rig tells its own frame period
    proc::SensorNoise noise;
    proc::Linearity response{};            ///< of the sensor; the identity unless it was measured
    Radians wedgeTolerance;                ///< of the mirror's wedges about either axis, k = 1
    double ledDrift = 0;                   ///< of the light between two captures, relative, k = 1
    Seconds warmUp{2};                     ///< of an LED, after the rig was without power
    double exposureRatio = 0;              ///< of an effective exposure time, relative, k = 1
    double linearity = 0;                  ///< what is left of it, relative, k = 1
    std::vector<Microseconds> exposures;   ///< ascending
    std::vector<double> dimLevels;         ///< fractions of full level, descending
    std::filesystem::path whiteReference;  ///< empty ("1/pi" in the file): without a table
    double blackReflectance = 0;
    double blackRelativeUncertainty = 0;
    double zeroUncertainty = 1e-5;  ///< of the light trap's f = 0, 1/sr, k = 1
    ValidityLimits validity;
    JudgingLimits quality;  ///< of the file that quality.limits names
};

/// Where config/ is: $GONIO_CONFIG, beside the installed program, or the source tree.
[[nodiscard]] std::filesystem::path configDirectory();

/// config/rigs/minidiff-usb2.toml.
[[nodiscard]] std::filesystem::path defaultProfile();

/// Errors name the file and the key. Paths inside are taken relative to configDirectory().
[[nodiscard]] Result<RigProfile> readProfile(const std::filesystem::path& file);

}  // namespace gonio::daemon
