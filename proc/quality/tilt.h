#pragma once
// How a sample lies under the rig, from the lobes that it shows to its LEDs. In: its calibrated f
// over CellGrid, as if it lay flat. Out: its normal n in the rig's frame, how well that is known,
// and the normal that each LED sees for itself.
//
// A surface on a tilt reflects by its own frame: with R the smallest turn that takes z to n, what
// is measured as f at (wi, wo) is
//     f'(wi, wo) = f(R^T wi, R^T wo) (R^T wo).z / wo.z,
// as the lit spot lies within the aperture's view. n is fitted jointly to all LEDs, with f a
// Lambert floor and one GGX lobe [Walter2007] common to them; where a real lobe is none, the misfit
// widens the uncertainty. Each LED's own normal is then fitted with that lobe held.
//
// In the plane of incidence (x) a lobe of another shape is taken for a tilt: by up to 1 degree
// under 60 degrees of incidence for Beckmann's, Ward's or Phong's, more than for any tilt's worth.
// At normal incidence, and across the plane (y), every lobe is even: there the shape does not
// matter. So x is the joint fit's only as far as the oblique LEDs agree with the one at the normal,
// and waves, by which LEDs disagree, are looked for across the plane; along it they count as far as
// they are no larger.
//
// A matt sample shows no lobe, and its tilt does no harm: no answer. Where there is a lobe and its
// fit leaves the normal open by more than half a degree, that is the answer:
// along z, within a quarter of a degree (k = 1, as rigs are seated), not determined. A lobe
// narrower than the cells (alpha < 0.02, 1 degree) is located to a fraction of a cell only.

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "proc/core/direction.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

/// What one LED sees of the surface that the normal is fitted with: diffuse / pi + specular D V F,
/// both the mean of the bands, F by Schlick with f0.
struct TiltLobe {
    double diffuse = 0;
    double specular = 1;
    double alpha = 0.1;
    double f0 = 0.04;
};

/// Standard uncertainty (k = 1) of a normal that is turned toward x and toward y.
struct TurnUncertainty {
    Radians towardX, towardY;

    [[nodiscard]] static TurnUncertainty even(Radians u) { return {u, u}; }
    [[nodiscard]] Radians larger() const { return std::max(towardX, towardY); }
    /// Root mean square of both.
    [[nodiscard]] Radians perAxis() const {
        return Radians(std::hypot(towardX.value(), towardY.value()) / std::sqrt(2.0));
    }
};

/// A normal, and how well it is known.
struct Normal {
    Direction direction;
    Radians u;  ///< per axis, the larger
    /// Without the lens map's part: against where the lobes were seen. What f is off by on a flank
    /// is this and the direction of the cell, which is in the budget by itself.
    TurnUncertainty uSeen;
    [[nodiscard]] Radians tilt() const { return direction.theta(); }
};

struct TiltEstimate {
    Normal joint;
    std::vector<std::optional<Normal>> leds;  ///< as the set's; empty: not determined
    std::vector<TiltLobe> lobes;              ///< by LED
    bool determined = true;                   ///< else there is a lobe, and `joint` is the seat's
    double misfit = 0;  ///< rms of (measured - fitted) / measured over the lobes, beyond the noise
    /// Root mean square angle between the LEDs' normals and the joint one, beyond the scatter and
    /// the misfit of their fits; 0 where these explain it. Both axes, from the one across the
    /// plane.
    Radians waviness;
    TurnUncertainty waves;  ///< the same by axis, of one LED's normal
};

/// `uAngle`: standard uncertainty of the lens map's directions, per axis. Empty without
/// a lobe or a cell measured.
[[nodiscard]] std::optional<TiltEstimate> estimateTilt(const SampleSet& sample, Radians uAngle);

/// A sample of so many LEDs whose tilt nothing tells, and whose f no tilt changes: what samples are
/// seated to.
[[nodiscard]] TiltEstimate seated(std::size_t leds);

/// f at a direction pair as a surface on a tilt shows it, by the fitted lobe.
[[nodiscard]] double tiltedLobe(const TiltLobe& lobe,
                                const Direction& normal,
                                const LightView& pair);

}  // namespace gonio::proc
