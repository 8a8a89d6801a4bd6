#pragma once
// A picture that came whole and with the right numbers, yet is not what was asked for: the one
// before, sent once more, or none at all. The driver's validity bits and capture numbers
// (driver/rig.h) tell of a rig that knows; these tell of one that does not.

#include <string>

#include "proc/core/frame.h"
#include "proc/radiance/dark.h"

namespace gonio::proc {

/// Bit for bit the same picture. No two exposures are: their noise differs. Where fewer than 1000
/// pixels are below full scale, or all are alike, there is no noise to tell by, and it is not.
[[nodiscard]] bool isRepeated(const Frame& frame, const Frame& before, const SensorNoise& noise);

/// A lit frame without light: its mean above the dark frame is below five standard uncertainties
/// and below 1e-4 of `whiteElectrons`, the mean electrons that white would show in it. False where
/// so little would be lost in the noise: nothing can be said there. `dark` is of the same window.
[[nodiscard]] bool showsNoLight(const Frame& lit,
                                const DarkFrame& dark,
                                double whiteElectrons,
                                const SensorNoise& noise);

}  // namespace gonio::proc
