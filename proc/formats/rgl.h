#pragma once
// RGL / EPFL .bsdf files [Dupuy2018]: a tensor file whose fields are description (text), jacobian,
// theta_i, phi_i, ndf, sigma, vndf, luminance, and rgb, or spectra and wavelengths. What the values
// mean: proc/table/tensor_table.h.
//
// Where a file has both, spectra are read and rgb is left out with a warning; so are fields that
// are none of these. The description holds all metadata, as lines. Numbers must be finite.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/formats/loss_report.h"
#include "proc/table/tensor_table.h"

namespace gonio::proc {

/// `name` stands in errors: "rgl: NAME: field 'ndf': ...".
[[nodiscard]] Result<FileRead<TensorTable>> parseRgl(std::string_view bytes, std::string_view name);

/// Usage error for a table whose sizes do not fit together, and for channels that are neither R, G,
/// B (written as rgb; one channel thrice) nor all wavelengths that ascend (written as spectra).
[[nodiscard]] Result<Written> writeRgl(const TensorTable& table, const Metadata& about = {});

}  // namespace gonio::proc
