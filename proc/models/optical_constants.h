#pragma once
// Refractive index and extinction of a material at the LED bands, from a table over wavelength in
// the layout of the refractiveindex.info database (YAML; `type: tabulated nk`, columns wavelength
// in micrometres, n, k). Between rows n and k are linear in wavelength; the bands must lie within
// them.

#include <filesystem>

#include "proc/core/bands.h"
#include "proc/core/result.h"

namespace gonio::proc {

struct OpticalConstants {
    LedBands eta;
    LedBands k;
};

/// A File error names the file and what is missing: the table, a row of three numbers, a band.
[[nodiscard]] Result<OpticalConstants> readOpticalConstants(const std::filesystem::path& file);

}  // namespace gonio::proc
