#pragma once
// Answers from a measured sample, isotropic: the light's azimuth is turned to 0.
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
    /// The LEDs are sorted by incidence here.
    explicit SampleLookup(SampleSet set);

    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] const SampleSet& set() const { return set_; }

private:
    SampleSet set_;
    std::vector<double> incidenceDeg_;
};

}  // namespace gonio::proc
