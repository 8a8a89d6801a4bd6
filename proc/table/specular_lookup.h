#pragma once
// The plain look-up of a SpecularTable: bilinear in (radial, azimuth) within the table of each
// incidence, linear between the two incidences at equal specular-relative coordinates. A node
// answers its own number. It is also the simulated rig's truth, so it stays as simple as this.
//
// An incidence below the first takes the first; above the last: no answer. Where any node that is
// needed has no data, and outside the axes: no answer, without flags. At and below the horizon: no
// answer, flag below_horizon. Where the axes are the centres of cells (a first radial within three
// quarters of a step of 0; azimuths likewise), the mean of the first ring stands at the pole, and
// azimuths go on to the mirror plane. Several rotations: linear between them at the light's
// azimuth; one rotation: isotropic. A plane-symmetrical table is mirrored.
//
// At a node: flag and source `measured`; between nodes `interpolated`. Monochrome: bandCount One,
// the same f for the three bands; LedBands: bandCount Three.

#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/table/specular_table.h"

namespace gonio::proc {

class SpecularLookup : public Scatterer {
public:
    /// File error for what has no f of the LED bands or no f in reflection: XYZ, BTDF; and for a
    /// table whose sizes do not fit together.
    [[nodiscard]] static Result<SpecularLookup> over(SpecularTable table);

    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] BandCount bandCount() const override {
        return table_.colour == TableColour::LedBands ? BandCount::Three : BandCount::One;
    }
    [[nodiscard]] const SpecularTable& table() const { return table_; }

private:
    explicit SpecularLookup(SpecularTable table);
    SpecularTable table_;
    std::vector<LedBands> f_;      ///< NaN where there is no data
    std::vector<LedBands> poles_;  ///< rotation > incidence; where the axes are centres of cells
};

}  // namespace gonio::proc
