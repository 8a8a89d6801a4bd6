#pragma once
// What a file, or a formula, is as the source of a conversion.

#include "proc/export/band_choice.h"
#include "proc/export/conversion.h"

namespace gonio::proc {

/// With the look-up of its own table, where it has one. Incidences are the file's; 0, 20, 40 and 60
/// degrees of one that holds all of them. Usage error as chosen().
[[nodiscard]] Result<ConversionSource> sourceOf(BrdfFile file, const BandChoice& choice);

/// At the incidences of the LEDs.
[[nodiscard]] ConversionSource sourceOf(std::shared_ptr<const Scatterer> formula, Metadata about);

}  // namespace gonio::proc
