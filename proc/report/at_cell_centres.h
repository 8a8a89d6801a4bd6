#pragma once
// A surface asked only at the centre of the cell (CellGrid) that a direction lies in: of what was
// measured at an LED's incidence, the cells as they are, with nothing blended between them. The
// light stands where it was asked for. No answer at and below the horizon.

#include "proc/core/scatterer.h"
#include "proc/optics/cell_grid.h"

namespace gonio::proc {

/// Borrows the surface.
class AtCellCentres : public Scatterer {
public:
    explicit AtCellCentres(const Scatterer& surface) : surface_(surface) {}

    [[nodiscard]] Answer answer(const LightView& pair) const override {
        const auto cell = CellGrid::cellAt(pair.out);
        if (!cell) return Answer::none({Flag::BelowHorizon}, Source::Measured);
        return surface_.answer({.in = pair.in, .out = CellGrid::centre(*cell)});
    }
    [[nodiscard]] BandCount bandCount() const override { return surface_.bandCount(); }

private:
    const Scatterer& surface_;
};

}  // namespace gonio::proc
