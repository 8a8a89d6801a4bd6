#pragma once
// Some of the bands of rows of several channels.

#include <span>

#include "proc/core/result.h"
#include "proc/table/brdf_rows.h"

namespace gonio::proc {

/// The channels are these bands, R, G, B; made of neighbouring wavelengths where the rows have no
/// channel of a band (band_channels.h): values linearly, random uncertainties as independent. Usage
/// error as bandChannels().
[[nodiscard]] Result<BrdfRows> onlyBands(const BrdfRows& rows, std::span<const Band> bands);

}  // namespace gonio::proc
