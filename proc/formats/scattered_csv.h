#pragma once
// Scattered BRDF values as the product's own CSV: directions as in csv_rows.h, then per channel the
// columns f, u (combined), u_random, u_systematic (k = 1) and flags (decimal masks), each with the
// channel's name behind an underscore: f_r, f_g, f_b for the LEDs' bands, f_650nm for a wavelength,
// f_NAME or f_NAME@650nm else; f alone for one channel of which nothing is known. Missing is empty.
// What eval writes is read, other columns are passed over.
//
// Metadata stand in comments (lines that start with #). One of them, "gonio.symmetry: isotropic" or
// "none", is there where the azimuths alone would tell another: lights of one azimuth are of an
// isotropic sample.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/formats/loss_report.h"
#include "proc/table/brdf_rows.h"

namespace gonio::proc {

/// Errors as in csv_rows.h.
[[nodiscard]] Result<FileRead<BrdfRows>> parseScatteredCsv(std::string_view text,
                                                           std::string_view name);

/// Angles in degrees, rounded to 1e-9; numbers in the shortest digits that read back the same.
[[nodiscard]] Written writeScatteredCsv(const BrdfRows& rows, const Metadata& about);

}  // namespace gonio::proc
