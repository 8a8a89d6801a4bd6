#pragma once
// Baseline: f in the layout of the MERL tables [Matusik2003], 90 x 90 x 180 nodes of theta_h (by
// its root, 90 (i / 90)^2 degrees), theta_d and phi_d (1 degree each, 180 of them, which are a
// circle by reciprocity), three planes of double. A node stands at the lower edge of its cell. What
// lies below the horizon is NaN in the table and left out of an answer, the other corners taking
// its weight. It is looked up by its angles, in double, as its readers do; it serves to be measured
// against.

#include <array>
#include <vector>

#include "proc/core/scatterer.h"

namespace gonio::proc {

enum class MerlLookup {
    Nearest,
    Trilinear
};

class MerlLayout {
public:
    explicit MerlLayout(const Scatterer& truth);

    /// NaN below the horizon, and where no corner has a value.
    [[nodiscard]] LedBands evaluate(const LightView& pair, MerlLookup how) const;
    [[nodiscard]] std::size_t bytes() const { return 3 * planes_[0].size() * sizeof(double); }

private:
    std::array<std::vector<double>, 3> planes_;
};

}  // namespace gonio::proc
