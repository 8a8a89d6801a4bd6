#pragma once
// Two dark frames of the whole sensor, one right after the other, and what they show: the black
// level, and the noise of one frame by their difference, which leaves out what both have: the
// fixed pattern, and what the dark current adds.

#include "driver/rig.h"
#include "proc/radiance/noise.h"

namespace gonio::daemon {

/// Exposed for 1 ms, or the rig's shortest exposure where that is longer: the dark current is
/// nothing. In the finest binning that the rig has; the window is the whole sensor's afterwards.
[[nodiscard]] Result<driver::Capture> takeDarkPair(driver::Rig& rig);

/// In DN, without pixels whose difference is beyond 5 sigma: hot ones have a noise of their own.
struct DarkNoise {
    double mean = 0;   ///< of both frames, black level included
    double sigma = 0;  ///< of one frame's pixel, k = 1
    double step = 0;   ///< from the second frame's mean to the first's
};

/// Precondition: two frames of one size, not empty.
[[nodiscard]] DarkNoise noiseOf(const driver::Capture& pair);

/// What the sensor's `noise` says of one dark pixel of such a frame, DN, k = 1.
[[nodiscard]] double expectedSigma(const proc::SensorNoise& noise, const Frame& frame);

}  // namespace gonio::daemon
