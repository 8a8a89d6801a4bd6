#pragma once
// What lies under the rig, and the light that it sends into each pixel. Rates are electrons per
// second at full level, computed once for each placement and LED.

#include <array>
#include <memory>
#include <vector>

#include "proc/core/image.h"
#include "proc/core/scatterer.h"
#include "sim/light.h"
#include "sim/optics.h"
#include "sim/reference_errors.h"

namespace gonio::sim {

enum class Role {
    Nothing,
    Sample,
    White,
    Black,
    Mirror
};

/// Wedges turn the surface: its normal is n = Ry(aboutY) Rx(aboutX) z. Only the mirror's are
/// simulated.
struct Wedge {
    Radians aboutX;
    Radians aboutY;
};

struct Placement {
    Role role = Role::Nothing;
    std::shared_ptr<const Scatterer>
        surface;  ///< of Sample, White, Black; shared with the host's truth
    Wedge wedge;
};

/// One image per band.
using RateImages = std::array<Image<float>, 3>;

/// Electrons per second at full level in each pixel of the window, of an LED on a placement. A
/// surface that does not answer reflects nothing. The mirror (reflectance 0.9) shows each LED as an
/// even disc of half a degree radius.
[[nodiscard]] RateImages rateImages(const Placement& placement,
                                    const ReferenceErrors& errors,
                                    const Optics& optics,
                                    Size size,
                                    ImagePoint corner,
                                    int led);

/// The direction in which a mirror with this wedge shows the LED.
[[nodiscard]] Direction mirrored(const Direction& light, const Wedge& wedge);

}  // namespace gonio::sim
