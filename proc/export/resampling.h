#pragma once
// What resampling cost: a written file, read back and asked where its source knows the answer.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "proc/core/scatterer.h"
#include "proc/table/brdf_rows.h"

namespace gonio::proc {

/// A pair with what the source says there.
struct Probe {
    LightView pair;
    LedBands f;  ///< NaN: no answer in this band
};

/// The source asked at the cells of these incidences, light at phi = -rotation, every cell or every
/// `stride`-th.
[[nodiscard]] std::vector<Probe> probesOf(const Scatterer& source,
                                          std::span<const double> incidenceDeg,
                                          std::span<const double> rotationDeg,
                                          std::size_t stride = 1);

/// f of each probe's own bands against what answers; a monochrome one in its one band.
struct ResamplingError {
    std::size_t compared = 0;
    std::size_t lost = 0;  ///< the source answers, the file does not
    /// |difference| / max(|f|, a thousandth of the mean f of the band), the largest.
    double largest = 0;
    /// Sum of |difference| cos(theta_o) over the sum of |f| cos(theta_o).
    double weighted = 0;
};

/// `bands` are those that are compared; empty where nothing can be.
[[nodiscard]] std::optional<ResamplingError> resamplingError(std::span<const Probe> probes,
                                                             const Scatterer& written,
                                                             std::span<const Band> bands);

}  // namespace gonio::proc
