#pragma once
// How far a pair of directions is from what was measured.

#include <vector>

#include "proc/core/direction.h"
#include "proc/estimate/sheet.h"
#include "proc/fit/brdf_data.h"

namespace gonio::proc {

struct Reach {
    double between = 0;         ///< 4 t (1 - t) between two incidences: 0 at one, 1 in the middle
    Radians beyondIncidence{};  ///< past the first or last incidence
    /// Layers of cells (sheet.h) between wo and what was measured, at the nearest incidences.
    double steps = 0;

    /// A little off what was measured, as rounding is.
    [[nodiscard]] bool within() const { return beyondIncidence < 0.01_deg && steps < 1e-6; }
};

class Coverage {
public:
    /// Of the groups that are wanted. A cell counts where any band has a value.
    Coverage(const BrdfData& data, const std::vector<bool>& groups);

    /// The pair above the horizon, its light at phi = 0.
    [[nodiscard]] Reach at(const LightView& pair) const;

private:
    std::vector<double> deg_;
    std::vector<Sheet> sheets_;  ///< of the constant 1
};

/// The cell that a row is of or lies in; empty at the horizon.
[[nodiscard]] std::optional<std::size_t> cellOf(const BrdfData& data, const FitRow& row);

}  // namespace gonio::proc
