#include "proc/formats/exr_tiles.h"

#include "proc/formats/exr_atlas.h"
#include "proc/formats/exr_tile_layout.h"

namespace gonio::proc {

Result<Written> encodeExrTiles(const SpecularTable& table,
                               const Metadata& about,
                               const ExrTileOptions& options) {
    const std::vector<AtlasSample> one{{.table = table, .about = about}};
    return encodeExrAtlas(one, {.half = options.half, .columns = options.columns});
}

Result<FileRead<SpecularTable>> decodeExrTiles(std::string_view bytes, std::string_view name) {
    auto samples = decodeExrAtlas(bytes, name);
    if (!samples) return samples.error();
    if (samples->size() != 1) {
        return Error{ErrorKind::File,
                     "exr-tiles: " + std::string(name) + ": an atlas of " +
                         std::to_string(samples->size()) + " samples, wanted one"};
    }
    return std::move(samples->front());
}

SpecularGrid exrTileGrid(std::vector<double> incidenceDeg, Size tile, TableSymmetry symmetry) {
    const bool half = symmetry == TableSymmetry::PlaneSymmetrical;
    const auto width = static_cast<std::size_t>(std::max(1, tile.width));
    const auto height = static_cast<std::size_t>(std::max(1, tile.height));
    return {.symmetry = symmetry,
            .incidenceDeg = std::move(incidenceDeg),
            .azimuthDeg = half ? centreDegrees((width + 1) / 2, 180) : centreDegrees(width, 360),
            .radialDeg = centreDegrees(height, 180)};
}

}  // namespace gonio::proc
