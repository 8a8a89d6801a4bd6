#pragma once
// The look-up of a KlemsTable: f is constant over each pair of patches. One face and one spectrum;
// wo above the surface is reflection, below it transmission, as far as the table has them
// (elsewhere no answer, flag below_horizon). The back is seen from behind: our x axis is then the
// front's -x, so that the frame is right-handed.
//
// At the middle of both patches: flag and source `measured`, elsewhere `interpolated`. Beyond the
// last ring: no answer. bandCount One: the value of the spectrum for all bands.

#include <string>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/table/klems_table.h"

namespace gonio::proc {

class KlemsLookup : public Scatterer {
public:
    struct Choice {
        KlemsFace face = KlemsFace::Front;
        std::string spectrum = "Visible";
    };
    /// File error where the table has neither reflection nor transmission of this choice (it says
    /// what there is), or where the sizes of a matrix do not fit.
    [[nodiscard]] static Result<KlemsLookup> over(KlemsTable table, const Choice& choice);

    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] BandCount bandCount() const override { return BandCount::One; }
    [[nodiscard]] const KlemsTable& table() const { return table_; }

private:
    KlemsLookup(KlemsTable table, const Choice& choice);

    KlemsTable table_;
    KlemsFace face_;
    std::optional<std::size_t> reflection_, transmission_;  ///< of table_.matrices
};

}  // namespace gonio::proc
