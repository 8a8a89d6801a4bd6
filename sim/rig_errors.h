#pragma once
// What is wrong with the rig itself, each with a size of its own. As constructed all are off: the
// sensor has its noise and its hot pixels and the LEDs their stray light, and nothing else. None of
// it is told to the host. What is wrong with a sample is in sample_errors.h, with the tiles in
// reference_errors.h.
//
// In text, for a command line: none, or names after commas, each with its size or without for the
// usual one, "glare=0.002,offset_us,step=0.05@300". `typical` stands for all that a rig has at
// once, at their usual sizes; a name that follows it overrides.
//   glare       0..0.05, usual 0.001: share of the light that is spread over the field (glare.h)
//   drift       0..0.05, usual 0.002: of the LEDs' light, relative standard size (led_drift.h)
//   step        -0.5..0.5 @ plan step: from that step on the LEDs give 1 + size of their light
//   offset_us   -14..14, usual 0.2: an exposure lasts longer than granted by so much
//   prnu        0..0.05, always 0.007: photo-response non-uniformity, relative standard size
//   column_e    0..20, usual 0.5: electrons (k = 1) by which a column of a frame is off
//   celsius     0..80, always 25: of the sensor
//   doubling_k  6..8, always 7: the dark current doubles each so many kelvin
//   inl         -0.02..0.02, usual 0.003: of full well, how far the response bows up at half of it
//   crosstalk   0..0.2, usual 0.01: share of a band's light that is other bands' (band_mixture.h)
//   source_deg  0..2, usual 1: diameter of the LEDs seen from the sample (source_disc.h)
//   wedge_deg   0..0.5, usual 0.01: a mirror's wedge is off by so much about either axis, k = 1
//   bits        8, 10 or 12, always 12: of a pixel

#include <cstdint>
#include <string_view>

#include "proc/core/result.h"
#include "proc/core/units.h"

namespace gonio::sim {

/// A sudden change of the light of all LEDs, at the same current.
struct LedStep {
    double size = 0;             ///< relative
    std::uint64_t planStep = 0;  ///< of the first capture that has it
    bool operator==(const LedStep&) const = default;
};

struct RigErrors {
    double glare = 0;
    double ledDrift = 0;
    LedStep ledStep{};
    Nanoseconds exposureOffset{0};
    double nonUniformity = 0.007;
    double columnNoise = 0;  ///< e-
    double celsius = 25;
    double doublingKelvin = 7;
    double nonLinearity = 0;
    double crosstalk = 0;
    Radians sourceDiameter{};
    Radians wedges{};
    int bits = 12;
    bool operator==(const RigErrors&) const = default;
};

/// What the text says, the rest as in `base`. Usage errors name what was wrong and what is wanted.
[[nodiscard]] Result<RigErrors> parseRigErrors(std::string_view text, const RigErrors& base);

}  // namespace gonio::sim
