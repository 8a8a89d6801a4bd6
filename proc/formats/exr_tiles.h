#pragma once
// A SpecularTable as a picture for shaders, OpenEXR: one tile per incidence, all of one size, in
// rows of `columns`. In a tile x is the azimuth and y the radial angle about the mirror direction;
// a value belongs to the centre of its pixel: azimuth 360 (x + 0.5) / width, radial
// 180 (y + 0.5) / height degrees. Channels R, G, B of the LED bands, or Y of one.
//
// Attributes: bsdfTileAngles (incidences, radians), bsdfMethod, bsdfSymmetry, bsdfType (BRDF,
// BTDF); of ours gonioAngleUnit, gonioPixelPhase, gonioTileColumns, gonioTis, gonioAbout (metadata
// as lines). Without gonioAngleUnit angles of which one is above pi/2 are degrees; without
// gonioTileColumns the tiles must divide the picture in one way only that makes pixels of equal
// steps. Both are said in a warning.
//
// A missing node is 0, as in the table. Not in the picture: several rotations, XYZ. A plane-
// symmetrical table is written with both sides, and read as one where both are the same.
//
// A picture of more than 8 MiB of floats and six times the file is refused: more than measured data
// ever shrink. What would shrink so far is written without compression.

#include <string_view>

#include "proc/core/image.h"
#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/formats/loss_report.h"
#include "proc/table/specular_fill.h"
#include "proc/table/specular_table.h"

namespace gonio::proc {

struct ExrTileOptions {
    bool half = false;        ///< 16 bits: at most 65504, 11 significant bits
    std::size_t columns = 0;  ///< tiles beside each other; 0: a picture nearly square
};

/// Usage error unless the table has one rotation, a colour that fits, and the centres of pixels for
/// axes (exrTileGrid).
[[nodiscard]] Result<Written> encodeExrTiles(const SpecularTable& table,
                                             const Metadata& about,
                                             const ExrTileOptions& options = {});
/// `name` stands in errors: "exr-tiles: NAME: 3 tiles do not divide 100 x 100 pixels".
[[nodiscard]] Result<FileRead<SpecularTable>> decodeExrTiles(std::string_view bytes,
                                                             std::string_view name);

/// The directions of tiles of this size; of a plane-symmetrical table the first half of the
/// columns.
[[nodiscard]] SpecularGrid exrTileGrid(std::vector<double> incidenceDeg,
                                       Size tile,
                                       TableSymmetry symmetry = TableSymmetry::Asymmetrical);

}  // namespace gonio::proc
