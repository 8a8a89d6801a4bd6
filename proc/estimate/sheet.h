#pragma once
// What one incidence measured in one band, as a quantity over the hemisphere of outgoing directions
// that can be asked anywhere above the horizon: bilinear between the cells of CellGrid, with cells
// that were not measured filled from those that were.
//
// Filling goes in layers from what was measured: a missing cell next to filled ones takes their
// mean, and their mean uncertainties. So a hole (the camera's own, a beam's, a saturated lobe) is
// closed from its rim and never from a blocked cell, and beyond the largest theta_o that was
// measured the quantity stays what it was at the edge. `steps` says how many layers away from a
// measured cell an answer is: 0 where every cell in it was measured.

#include <cstdint>
#include <optional>
#include <vector>

#include "proc/core/direction.h"

namespace gonio::proc {

/// In the unit of the quantity; uncertainties are standard.
struct SheetValue {
    double value = 0;
    double uRandom = 0;      ///< independent between cells
    double uSystematic = 0;  ///< common to all cells
    double steps = 0;        ///< layers of filling, weighted as the cells are
};

class Sheet {
public:
    /// One number per cell of CellGrid; NaN where it was not measured. Empty where no cell has a
    /// value.
    struct Cells {
        std::vector<double> value, uRandom, uSystematic;

        [[nodiscard]] static Cells missing();
    };
    [[nodiscard]] static std::optional<Sheet> over(Cells cells);

    /// wo above the horizon.
    [[nodiscard]] SheetValue at(const Direction& wo) const;

private:
    explicit Sheet(Cells cells);
    void fill();

    Cells cells_;
    std::vector<std::int16_t> steps_;  ///< -1 while not filled
};

/// The cells that share an edge or a corner with one, in ascending order.
[[nodiscard]] const std::vector<std::uint32_t>& neighboursOf(std::size_t cell);

}  // namespace gonio::proc
