#pragma once
// The light that what lies under the rig sends into each pixel. Rates are electrons per second at
// full level, computed once for each placement and LED.

#include <array>

#include "proc/core/image.h"
#include "sim/light.h"
#include "sim/optics.h"
#include "sim/placement.h"
#include "sim/sensor.h"

namespace gonio::sim {

/// Where each pixel of a view looks: all of the optics that no placement changes.
class FieldOfView {
public:
    FieldOfView(const Optics& optics, const View& view);

    [[nodiscard]] const View& view() const { return view_; }
    /// The direction of the pixel's middle; meaningless where transmission() is 0.
    [[nodiscard]] const Direction& direction(int x, int y) const { return directions_.at(x, y); }
    /// Solid angle times vignetting relative to the middle of the field; 0 outside the field stop.
    [[nodiscard]] double transmission(int x, int y) const { return double{transmission_.at(x, y)}; }

private:
    View view_;
    Image<Direction> directions_;
    Image<float> transmission_;
};

/// One image per band.
using RateImages = std::array<Image<float>, 3>;

/// Electrons per second of an LED at full level in each pixel of a field, before any glare.
struct LedLight {
    RateImages steady;
    RateImages lobe{};  ///< of a soft sample, what there is more while it is pressed; else empty
};

/// Of an LED on a placement. A surface that does not answer reflects nothing. The mirror
/// (reflectance 0.9) shows each LED as an even disc: of the rig's source, of half a degree radius
/// where that is a point.
[[nodiscard]] LedLight ledLight(const Placement& placement,
                                const Flaws& flaws,
                                const Optics& optics,
                                const FieldOfView& field,
                                int led);

/// Electrons per second that leak into each pixel (sample_errors.h).
[[nodiscard]] Image<float> ambientLight(const SampleErrors& errors, const FieldOfView& field);

}  // namespace gonio::sim
