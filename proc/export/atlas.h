#pragma once
// Several samples in one picture for shaders: proc/formats/exr_atlas.h, asked at the same pixels.

#include <span>

#include "proc/export/conversion.h"

namespace gonio::proc {

/// In the order of the sources, at the grid's incidences, or those of the first. Usage error where
/// one of them answers nothing between its values, or they do not go together.
[[nodiscard]] Result<Written> atlasOf(std::span<const ConversionSource> sources,
                                      const ConversionWish& wish);

}  // namespace gonio::proc
