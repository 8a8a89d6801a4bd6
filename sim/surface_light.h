#pragma once
// The light that a surface under one LED sends out: f cos(theta_o), with all that is wrong with how
// it lies, what it is and what shines on it. With nothing wrong, exactly the surface's f times
// wo.z.

#include <memory>
#include <vector>

#include "sim/placement.h"
#include "sim/source_disc.h"

namespace gonio::sim {

class SurfaceLight {
public:
    SurfaceLight(const Placement& placement, const Flaws& flaws, int led);

    /// Per band, in the rig's directions. A surface that does not answer reflects nothing; one that
    /// knows the middle of the source and not its rim, as a table of the four LEDs does, is asked
    /// for the middle only. Below a tilted surface's horizon: nothing.
    [[nodiscard]] LedBands towards(const Direction& wo) const;
    /// How much of a pressed sample's excess is seen from here: 1 in the mirror direction.
    [[nodiscard]] double lobeShapeAt(const Direction& wo) const;

private:
    [[nodiscard]] LedBands meanOverSource(const Direction& out) const;

    std::shared_ptr<const Scatterer> surface_;  // the placement's
    Pose pose_;
    std::vector<SourcePoint> source_;  // in the surface's frame, the middle first
    Radians turned_;
    double crosstalk_;
    LedBands subsurface_;
    WhiteErrors white_;
    double black_ = 1;
    double zero_ = 0;  // f where there is no surface: what a light trap leaves
};

}  // namespace gonio::sim
