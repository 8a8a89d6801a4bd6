#pragma once
// How far a pair of directions is from what was measured, band by band: where red was saturated,
// green may have been measured.

#include <array>
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
    /// Of the groups that are wanted.
    Coverage(const BrdfData& data, const std::vector<bool>& groups);

    /// By band. The pair above the horizon, its light at phi = 0.
    [[nodiscard]] std::array<Reach, 3> at(const LightView& pair) const;
    /// Whether the band was measured anywhere.
    [[nodiscard]] bool has(std::size_t band) const { return !kinds_[kindOf_[band]].deg.empty(); }
    /// BrdfData::exchanges
    [[nodiscard]] bool exchanges() const { return exchanges_; }

private:
    /// What bands that were measured at the same places share.
    struct Kind {
        std::vector<double> deg;
        std::vector<Sheet> sheets;  ///< of the constant 1

        [[nodiscard]] Reach at(const LightView& pair) const;
    };
    static Kind kindOf(const BrdfData& data,
                       const std::vector<bool>& groups,
                       const std::vector<bool>& measured);

    std::vector<Kind> kinds_;
    std::array<std::size_t, 3> kindOf_{};  ///< by band
    bool exchanges_;
};

/// The cell that a row is of or lies in; empty at the horizon.
[[nodiscard]] std::optional<std::size_t> cellOf(const BrdfData& data, const FitRow& row);

}  // namespace gonio::proc
