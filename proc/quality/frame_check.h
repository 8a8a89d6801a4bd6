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
    Darker,    ///< less than 0.6 of the light that it should have brought at least
    Brighter,  ///< more than 1 / 0.6 of what it should have brought at most
    Reflex     ///< a part is saturated that the other shows to be dim
};

/// What pixels say on average where there is no light, and how far that may be off; DN.
struct BlackLevel {
    double dn = 0, u = 0.5;
    bool holdsLeaks = false;  ///< the light that comes with any level is in it
};

/// A picture, borrowed, and its black level.
struct Shown {
    const Frame* frame = nullptr;
    BlackLevel black{};
};

/// `frame` against what `before` foretells: its light in the proportion of the granted exposures.
/// Of another level it is told only where the higher one of the two shows less light, as light may
/// come with any level; where the black levels hold that, where the two are more than a factor of
/// three off the levels, as an LED's light does not go quite with its current. What the sensor may
/// add to one of two exposures (15 us), the noise of both, and black levels that are off explain
/// what they can. It is told of the whole picture, or of three blocks of 4 x 4 pixels, which see a
/// small highlight. A reflex is three blocks or more, half of each at least at full scale, of which
/// the whole block had surely less than 0.7 of the light that this wants. Agrees where windows or
/// gains differ.
[[nodiscard]] Agreement agreement(const Shown& frame,
                                  const Shown& before,
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
