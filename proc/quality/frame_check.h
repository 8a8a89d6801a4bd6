#pragma once
// A picture that came whole and with the right numbers, yet is not what was asked for: the one
// before, sent once more, or none at all, or one of another exposure or of other light. The
// driver's validity bits and capture numbers (driver/rig.h) tell of a rig that knows; these tell of
// one that does not.

#include <string>

#include "proc/core/frame.h"
#include "proc/radiance/dark.h"

namespace gonio::proc {

/// Bit for bit the same picture. No two exposures are: their noise differs. Where fewer than 1000
/// pixels are below full scale and have a noise of half a DN, or all are alike, there is no noise
/// to tell by, and it is not.
[[nodiscard]] bool isRepeated(const Frame& frame, const Frame& before, const SensorNoise& noise);

/// Every pixel alike and below full scale: no picture, as a sensor's noise would show. False where
/// rounding hides it (a read noise below half a DN), and of fewer than 1000 pixels.
[[nodiscard]] bool isBlank(const Frame& frame, const SensorNoise& noise);

/// How a picture goes with one before it, of the same scene and LED.
enum class Agreement {
    Agrees,    ///< or nothing can be said
    Darker,    ///< less than 0.6 of the light that its exposure should have brought
    Brighter,  ///< more than 1 / 0.6 of it
    Reflex     ///< a part is saturated that the other shows to be dim
};

/// `frame` against what `before` foretells, pixel by pixel: its light in the proportion of the
/// granted exposures and, of another level, of the levels. What the sensor may add to either
/// exposure (15 us), the noise of both, and a black level that is off by half a DN explain what
/// they can. Of another level only a reflex is told, and light that comes with any level is let be.
/// Of every second row and column; a reflex is 12 such pixels or more. Agrees where the windows
/// differ.
[[nodiscard]] Agreement agreement(const Frame& frame,
                                  const Frame& before,
                                  Band band,
                                  const SensorNoise& noise);

/// A lit frame without light: its mean above the dark frame is below five standard uncertainties
/// and below 1e-4 of `whiteElectrons`, the mean electrons that white would show in it. False where
/// so little would be lost in the noise: nothing can be said there. `dark` is of the same window.
[[nodiscard]] bool showsNoLight(const Frame& lit,
                                const DarkFrame& dark,
                                double whiteElectrons,
                                const SensorNoise& noise);

}  // namespace gonio::proc
