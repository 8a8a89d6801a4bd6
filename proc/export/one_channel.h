#pragma once
// One channel out of a file of several, as a file of one value: a scan, a wavelength, a tristimulus
// value. Names that are none of the LEDs' bands go into the metadata "channel".

#include <cstddef>

#include "proc/core/result.h"
#include "proc/formats/brdf_file.h"

namespace gonio::proc {

/// `number` counts from 1. The band is the channel's, where its name or wavelength tells. Of a
/// sample and of a table in R, G and B the band stands in `bands`, and nothing is taken out. Usage
/// error for a number that the file does not have.
[[nodiscard]] Result<BrdfFile> withChannelAlone(BrdfFile file, std::size_t number);

}  // namespace gonio::proc
