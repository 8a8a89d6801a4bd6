#pragma once
// Pictures of few colours as PNG, and as what a document holds within itself.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/result.h"

namespace gonio::proc {

using Rgba = std::array<std::uint8_t, 4>;  ///< not premultiplied

struct IndexedPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> pixels;  ///< row by row from the top, each an index into `colours`
    std::vector<Rgba> colours;         ///< 1 to 256
};

/// PNG bytes, the same for the same picture. Internal error for a picture without pixels, of
/// another number of them than its size says, or with an index that has no colour.
[[nodiscard]] Result<std::string> encodePng(const IndexedPicture& picture);

/// "data:image/png;base64,...".
[[nodiscard]] std::string pngUri(std::string_view png);

}  // namespace gonio::proc
