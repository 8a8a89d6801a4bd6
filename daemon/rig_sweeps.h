#pragma once
// What is found out about the rig itself, over the white reference: how its sensor answers
// (exposures up and down again, at constant light), and how its LEDs answer to their own warmth.
// The LEDs are dark afterwards, however it ends.

#include <vector>

#include "daemon/measurement.h"
#include "proc/radiance/led_monitor.h"
#include "proc/radiance/linearity.h"
#include "proc/radiance/photon_transfer.h"

namespace gonio::daemon {

/// What a sensor is: gain and read noise, and the shape of its response.
struct SensorRecord {
    proc::PhotonTransfer transfer;
    proc::LinearityFit linearity;
    std::vector<proc::SweepPoint> sweep;
    std::optional<double> celsius{};  ///< of the sensor
    std::string dateUtc;
};

/// Pairs of frames at 16 exposures, evenly spread to 85 % of full scale, upwards and downwards: a
/// light that drifts steadily cancels. In a part of the field that the white lights evenly. Quality
/// error where it is too dark for that, and where the figures make no sense.
[[nodiscard]] Result<SensorRecord> measureSensor(const Bench& bench);
/// Steps of progress.
[[nodiscard]] int sensorSteps();

/// The rig as it is with its sensor measured: gain, read noise, response, and how well that is
/// known. Its hash ends in "/ID", so that what was calibrated without it is told from it.
[[nodiscard]] RigProfile withSensor(RigProfile profile,
                                    const SensorRecord& sensor,
                                    std::int64_t id);

/// Of one LED, band by band, four times over: dark for 6 s, until it is cold, then lit for 4 s.
[[nodiscard]] Result<proc::LedMonitor> measureWarmUp(const Bench& bench);
[[nodiscard]] int warmUpSteps();

}  // namespace gonio::daemon
