#pragma once
// Several samples in one picture: the tiles of exr_tiles.h, each split into `innerColumns` x rows
// of inner tiles, one per sample, row by row. All samples share directions, kind and colour; one
// that is monochrome among bands has them equal. gonioAtlas holds the number of samples and of
// inner columns; the metadata of sample k are gonioAbout and k.

#include <span>
#include <string_view>
#include <vector>

#include "proc/formats/exr_tiles.h"

namespace gonio::proc {

struct AtlasSample {
    SpecularTable table;
    Metadata about;
};

inline constexpr std::size_t kMostAtlasSamples = 4096;

struct ExrAtlasOptions {
    bool half = false;
    std::size_t columns = 0;       ///< of tiles; 0: a picture nearly square
    std::size_t innerColumns = 0;  ///< of samples within a tile; 0: nearly as many as rows
};

/// Usage error for no sample, and for one that does not go with the first.
[[nodiscard]] Result<Written> encodeExrAtlas(std::span<const AtlasSample> samples,
                                             const ExrAtlasOptions& options = {});
/// In the order of the file. A picture of tiles is an atlas of one sample.
[[nodiscard]] Result<std::vector<FileRead<SpecularTable>>> decodeExrAtlas(std::string_view bytes,
                                                                          std::string_view name);

}  // namespace gonio::proc
