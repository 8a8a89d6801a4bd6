#pragma once
// What one state (LED x channel) measured: BRDF per cell of CellGrid with its standard
// uncertainties (k = 1), split into what is independent from cell to cell and what is not. A
// missing cell has f = u = NaN, nEff = 0 and its flag `measured` clear. Missing is never 0.

#include <cstddef>
#include <limits>
#include <vector>

#include "proc/core/flags.h"
#include "proc/core/measured.h"

namespace gonio::proc {

struct CellSamples {
    std::vector<double> f;            ///< 1/sr
    std::vector<double> uRandom;      ///< 1/sr
    std::vector<double> uSystematic;  ///< 1/sr
    std::vector<double> nEff;         ///< effective number of independent pixels
    std::vector<Flags> flags;

    /// `cells` cells, all missing.
    [[nodiscard]] static CellSamples missing(std::size_t cells) {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        return {std::vector(cells, nan),
                std::vector(cells, nan),
                std::vector(cells, nan),
                std::vector(cells, 0.0),
                std::vector(cells, Flags{})};
    }

    [[nodiscard]] std::size_t size() const { return f.size(); }
    [[nodiscard]] bool present(std::size_t cell) const { return flags[cell].has(Flag::Measured); }
    /// There is such a cell, and its value is good for estimates and fits: measured, and neither
    /// saturated nor blocked nor below the horizon.
    [[nodiscard]] bool usable(std::size_t cell) const {
        return cell < flags.size() && present(cell) && !flags[cell].has(Flag::Saturated) &&
               !flags[cell].has(Flag::Blocked) && !flags[cell].has(Flag::BelowHorizon);
    }
    [[nodiscard]] Measured<double> at(std::size_t cell) const {
        return {f[cell], uRandom[cell], uSystematic[cell], flags[cell]};
    }
};

}  // namespace gonio::proc
