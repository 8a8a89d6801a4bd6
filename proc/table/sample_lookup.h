#pragma once
// Answers from a measured sample. Of one rotation it is taken as isotropic: the light's azimuth is
// turned to 0. Of several rotations, linear between the two that the light's azimuth lies between
// (rotation r put the light at azimuth -r), light and view turned together; no answer at an azimuth
// where no two neighbouring rotations (axis.h, placeOnCircle) enclose it. At the normal the light
// has no azimuth: the first rotation answers there.
//
// Within 0.5 degrees of an LED's incidence: that LED's cells, bilinear between cell centres (two
// rows, each linear in phi, across the pole at the normal). Between two LEDs: linear in incidence
// at equal specular-relative coordinates. Beyond the first or last LED by more than 0.5 degrees: no
// answer. A missing cell that is needed: no answer in that band, with the cells' flags.
//
// At a cell centre of an LED: source `measured`; else `interpolated`. u_random adds as independent
// between cells, u_systematic as common to them.

#include "proc/core/scatterer.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

class SampleLookup : public Scatterer {
public:
    /// The LEDs are sorted by rotation and incidence here.
    explicit SampleLookup(SampleSet set);

    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] const SampleSet& set() const { return set_; }

private:
    /// The tables of one rotation: from `first` on, as many as there are incidences.
    struct Turn {
        Radians rotation;
        std::size_t first = 0;
        std::vector<double> incidenceDeg;
    };
    class Blend;
    bool addTurn(Blend& blend, const Turn& turn, const LightView& pair, double weight) const;
    [[nodiscard]] Answer blended(const Blend& blend) const;

    SampleSet set_;
    std::vector<Turn> turns_;
    std::vector<double> rotationDeg_;
};

}  // namespace gonio::proc
