#pragma once
// The dark library: mean dark frames of all exposures at one temperature of the sensor, kept with
// the calibrations. A sample that is measured while one of its temperature is good takes no dark
// frames of its own but the few beside the planning, which show light that leaks in.

#include <optional>
#include <string>
#include <vector>

#include "daemon/calibrations.h"
#include "daemon/measurement.h"
#include "proc/radiance/dark.h"

namespace gonio::daemon {

/// 32 frames of each exposure that a sample may ask for, with the LEDs dark.
[[nodiscard]] Result<std::vector<proc::DarkFrame>> measureDarks(const Bench& bench);
/// Steps of progress.
[[nodiscard]] int storedDarkSteps(const Bench& bench);

/// Of those of the rig that are good: the one taken nearest to this temperature, within 1 K of it;
/// the newest of such. Empty: there is none, or the rig tells no temperature of its sensor.
[[nodiscard]] std::optional<CalibrationRecord> darksAt(Store& store,
                                                       std::optional<double> sensorCelsius,
                                                       const RigNow& now,
                                                       const ValidityLimits& limits);
[[nodiscard]] Result<std::vector<proc::DarkFrame>> readDarks(const CalibrationRecord& record);

}  // namespace gonio::daemon
