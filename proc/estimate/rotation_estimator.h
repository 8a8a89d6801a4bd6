#pragma once
// Answers for a sample that was measured at several rotations of the stage: of each rotation an
// estimator of its own (sample_estimator.h), which takes the light's azimuth as that rotation's; in
// between, linear over the light's azimuth, light and view turned together. With t in [0, 1] the
// place between two rotations,
//     f = (1 - t) f_low + t f_high,
//     u_random^2 = ((1 - t) u_low)^2 + (t u_high)^2,
//     u_systematic = (1 - t) u_low + t u_high, and in quadrature t (1 - t) |f_high - f_low|,
// which is what a wave of half a turn, as a grain makes, would be off by. At a rotation: its own
// answer. Where no two neighbouring rotations (axis.h, placeOnCircle) enclose the azimuth: the
// nearest one's, flagged extrapolated, with half of what the rotations differ by here in
// u_systematic. At the normal, where the light has no azimuth, the first rotation answers.

#include <functional>
#include <memory>
#include <vector>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/core/units.h"

namespace gonio::proc {

class RotationEstimator final : public Scatterer {
public:
    /// `of`: the estimator of what was measured at a rotation; it is asked in the rig's frame, the
    /// light at phi = 0. At least two rotations, ascending (rotations.h). The first error ends it.
    using Make = std::function<Result<std::shared_ptr<const Scatterer>>(Radians rotation)>;
    [[nodiscard]] static Result<std::unique_ptr<const RotationEstimator>> over(
        const std::vector<Radians>& rotations, const Make& of);

    [[nodiscard]] Answer answer(const LightView& pair) const override;

private:
    struct Turn {
        Radians rotation;
        std::shared_ptr<const Scatterer> estimator;  ///< shared with who made it
    };
    [[nodiscard]] Answer nearest(const LightView& inRig, double azimuthDeg) const;

    std::vector<Turn> turns_;
    std::vector<double> rotationDeg_;
};

}  // namespace gonio::proc
