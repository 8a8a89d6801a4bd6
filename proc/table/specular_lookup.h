#pragma once
// The plain look-up of a SpecularTable: bilinear in (radial, azimuth) within the table of each
// incidence, linear between the two incidences at equal specular-relative coordinates. A node
// answers its own number. It is also the simulated rig's truth, so it stays as simple as this.
//
// An incidence below the first takes the first; above the last: no answer. Where any node that is
// needed has no data, and outside the axes: no answer, without flags. At and below the horizon: no
// answer, flag below_horizon; a table of transmission answers below it, and not above. Several
// rotations: linear between them at the light's azimuth; one rotation: isotropic. A
// plane-symmetrical table is mirrored. Where the axes are the centres of cells (a first radial
// within three quarters of a step of 0; azimuths likewise), the mean of the first ring stands at
// the pole, and azimuths go on to the mirror plane.
//
// At a node: flag and source `measured`; between nodes `interpolated`. Monochrome: bandCount One,
// the same f for the three bands. R, G, B: an answer has those that have one.

#include <cstddef>
#include <optional>
#include <vector>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/table/specular_table.h"

namespace gonio::proc {

class SpecularLookup : public Scatterer {
public:
    /// File error for XYZ, which is no f of the LED bands, and for a table whose sizes do not fit
    /// together.
    [[nodiscard]] static Result<SpecularLookup> over(SpecularTable table);

    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] BandCount bandCount() const override {
        return planes_ == 1 ? BandCount::One : BandCount::Three;
    }
    [[nodiscard]] const SpecularTable& table() const { return table_; }

private:
    struct TablePlace;
    explicit SpecularLookup(SpecularTable table);
    static std::optional<TablePlace> placeIn(const SpecularTable& table, const LightView& pair);
    [[nodiscard]] double valueAt(std::size_t plane, const TablePlace& place) const;
    /// The mean of the ring about the mirror direction.
    [[nodiscard]] double poleAt(std::size_t plane, TableNode node) const;

    SpecularTable table_;
    std::size_t planes_ = 1;
    std::vector<double> f_;  ///< plane > node; NaN where there is no data
};

}  // namespace gonio::proc
