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
#include "sim/sensor.h"

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

/// Electrons per second at full level in each pixel of the field, of an LED on a placement. A
/// surface that does not answer reflects nothing. The mirror (reflectance 0.9) shows each LED as an
/// even disc of half a degree radius.
[[nodiscard]] RateImages rateImages(const Placement& placement,
                                    const ReferenceErrors& errors,
                                    const Optics& optics,
                                    const FieldOfView& field,
                                    int led);

/// The direction in which a mirror with this wedge shows the LED.
[[nodiscard]] Direction mirrored(const Direction& light, const Wedge& wedge);

}  // namespace gonio::sim
