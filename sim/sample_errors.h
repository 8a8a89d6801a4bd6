#pragma once
// What is wrong with a sample that lies under the rig, each with a size of its own; as constructed
// all are off. Its tilt is the Wedge of its placement (pose.h). None of it changes the truth: that
// is what the sample would show flat, opaque, relaxed and in the dark.
//
//   waviness      the surface's normal differs between the LEDs' spots: by so much, root mean
//                 square over the four, about the placement's normal
//   translucency  t: the share of red light that would reach a perfect backing and leave again, all
//                 directions alike; of green 0.6 and of blue 0.4 of it, as long waves go deeper. f
//                 rises by t(band) R / pi, R = 0.9 of a white backing, 0.03 of a black one
//   softness      s: the sample was pressed against the rig and relaxes. Its lobe is too bright by
//                     s exp(-t / 1 s) exp(-(delta / 10 deg)^2 / 2),   delta: from the mirror
//                 direction, t: the photometric clock (led_drift.h) since it was placed
//   ambient       a: light that leaks in between sample and rig, LEDs on or off: in the middle of
//                 the field as much as f cos(theta_o) = a shows under the first LED's green at full
//                 level, 1 + wo.y / 2 times as much elsewhere

#include "proc/core/bands.h"
#include "proc/core/result.h"
#include "proc/core/units.h"

namespace gonio::sim {

enum class Backing {
    Black,
    White
};

struct SampleErrors {
    Radians waviness{};
    double translucency = 0;
    Backing backing = Backing::Black;
    double softness = 0;
    double ambient = 0;
    bool operator==(const SampleErrors&) const = default;
};

/// What a translucent sample's backing adds to f, 1/sr.
[[nodiscard]] LedBands subsurface(const SampleErrors& errors);

/// The factor on the light at `fromMirror` from the mirror direction is 1 + this, at a time on the
/// photometric clock since the sample was placed.
[[nodiscard]] double pressed(const SampleErrors& errors, Nanoseconds sincePlaced);
[[nodiscard]] double lobeShape(Radians fromMirror);

/// Usage error, naming the first that is out of its domain: waviness 0..10 degrees, translucency
/// 0..1, softness 0..1, ambient 0..1.
[[nodiscard]] Result<void> check(const SampleErrors& errors);

}  // namespace gonio::sim
