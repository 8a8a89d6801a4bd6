#pragma once
// Cross-talk between the bands: the light of an LED's band lies partly in its neighbours', and the
// camera sees all of it. With a share c of other bands' light in each band, what it shows of f is
//     R: (1 - c) R + c G      G: c/2 R + (1 - c) G + c/2 B      B: c G + (1 - c) B,
// also of the white and of the black. This mixture is the truth of the band: a perfect measurement
// gives it. At c = 0 it is f itself, and bands that are alike stay so.

#include <memory>

#include "proc/core/bands.h"
#include "proc/core/scatterer.h"

namespace gonio::sim {

[[nodiscard]] LedBands bandMixture(const LedBands& f, double share);

/// What a rig with cross-talk shows of a surface when nothing else is wrong: f alone, without the
/// surface's uncertainties. No answer where the surface has none.
class MixedBands : public Scatterer {
public:
    MixedBands(std::shared_ptr<const Scatterer> surface, double share)
        : surface_(std::move(surface)), share_(share) {}
    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] BandCount bandCount() const override { return surface_->bandCount(); }

private:
    std::shared_ptr<const Scatterer> surface_;  // shared with the material that was opened
    double share_;
};

}  // namespace gonio::sim
