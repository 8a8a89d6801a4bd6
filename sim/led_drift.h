#pragma once
// How the light of the LEDs departs from nominal although their current is constant. Of an LED and
// band, relative to nominal,
//     output = 1 + s (z - d h),   s: the size, a relative standard deviation.
// h is the heat of the board that all LEDs sit on: h' = (level - h) / 2 s, level the sum of the
// drive levels, 0 when cold, 1 when one LED's band is at full level for long. d says what heat
// costs: 2 in red (AlInGaP loses 0.5 to 1 % per kelvin), 0.5 in green and blue (InGaN, 0.1 to 0.3
// %). z wanders: drawn from the seed, a standard normal at any plan step, changing by about a tenth
// over a bracket and independent after 128 steps. Plan steps never come again, so that no two
// placements share their z, however often the rig was switched on between. Size 0: the output is 1
// exactly.
//
// Heat comes and goes with the photometric clock, which exposures and settling advance and nothing
// else: never the wall clock, so that frames do not depend on how fast the host is. The board cools
// in dark frames; a pause between captures cools nothing.
//
// From a plan step on, all LEDs may give another share of their light at once: a step multiplies
// the output by 1 + its size.
//
// The board is warmer than its surroundings by 3 K times h, which its sensor shows; the drive
// current that the rig measures shows none of it.

#include <cstdint>

#include "proc/core/bands.h"
#include "proc/core/units.h"
#include "sim/exposing.h"
#include "sim/light.h"
#include "sim/rig_errors.h"

namespace gonio::sim {

class LedDrift {
public:
    LedDrift(std::uint64_t seed, double size, const LedStep& step = {})
        : seed_(seed), size_(size), step_(step) {}

    /// The photometric clock runs for so long with this light.
    void run(const Settings& settings, Nanoseconds time);
    /// Of the bands of an LED as warm as it is now, in a capture of this plan step.
    [[nodiscard]] LedBands output(int led, std::uint64_t planStep) const;

    /// h.
    [[nodiscard]] double heat() const { return heat_; }
    /// Of the board, over that of a dark one.
    [[nodiscard]] double boardKelvin() const;
    [[nodiscard]] double wander(int led, Band band, std::uint64_t planStep) const;

private:
    std::uint64_t seed_;
    double size_;
    LedStep step_;
    double heat_ = 0;
};

}  // namespace gonio::sim
