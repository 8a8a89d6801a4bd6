#pragma once
// Our own walk over the headers of an OpenEXR file, before the library sees them: the library
// allocates what a header promises.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/exr_parts.h"

namespace gonio::proc {

/// File error unless every attribute ends within the bytes, every part is of scan lines, lossless
/// compression and a size within the limits, and their number is too.
[[nodiscard]] Result<void> walkExrHeaders(std::string_view bytes, ExrLimits limits);

}  // namespace gonio::proc
