#pragma once
// The look-up of a HalfDifferenceTable: trilinear in (root of theta_half, theta_diff, phi_diff),
// the azimuth going round: at 180 degrees follows 0 by reciprocity. Where a node that is needed has
// no data: no answer, without flags. At and below the horizon: no answer, flag below_horizon.
//
// At a node: flag and source `measured`; between nodes `interpolated`. Beyond the last theta_half
// or theta_diff (a cell before 90 degrees) the last one answers, `extrapolated`.

#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/table/half_difference_table.h"

namespace gonio::proc {

class HalfDifferenceLookup : public Scatterer {
public:
    /// File error for planes whose sizes are not those of the axes, or that are empty.
    [[nodiscard]] static Result<HalfDifferenceLookup> over(HalfDifferenceTable table);

    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] const HalfDifferenceTable& table() const { return table_; }

private:
    explicit HalfDifferenceLookup(HalfDifferenceTable table) : table_(std::move(table)) {}
    HalfDifferenceTable table_;
};

}  // namespace gonio::proc
