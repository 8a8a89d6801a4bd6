#pragma once
// Tables into the pixels of a picture of tiles, and back.

#include <span>

#include "proc/formats/exr_atlas.h"
#include "proc/formats/exr_parts.h"
#include "proc/formats/exr_tile_layout.h"

namespace gonio::proc {

/// The most bytes of pixels, as floats, that are read from a file of a size.
[[nodiscard]] constexpr std::size_t mostPixelBytes(std::size_t fileBytes) {
    constexpr std::size_t kAlways = std::size_t{8} << 20U;
    return kAlways + 6 * fileBytes;
}

/// Adds the channels R, G, B, or Y where all samples are monochrome. The part's size is the
/// layout's. What is not finite in a float, or below the horizon, is 0; the former is counted.
void paintSamples(ExrPart& part,
                  std::span<const AtlasSample> samples,
                  const ExrTileLayout& layout,
                  LossReport& loss);

/// Moves channel after channel into planes of the tables, whose axes are the layout's, and frees
/// it.
void takeSamples(ExrPart& part, std::span<SpecularTable> tables, const ExrTileLayout& layout);

/// Whether each tile's right half is the left one's mirror image.
[[nodiscard]] bool isMirrored(const SpecularTable& table);
/// Drops the second half of the azimuths.
void keepOneSide(SpecularTable& table);

}  // namespace gonio::proc
