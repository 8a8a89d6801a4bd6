#pragma once
// Where the tiles of a picture lie, and which directions their pixels have: shared by exr_tiles.h
// and exr_atlas.h.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proc/core/image.h"
#include "proc/table/specular_table.h"

namespace gonio::proc {

struct ExrTileLayout {
    std::size_t tiles = 0, columns = 1;         ///< one per incidence
    std::size_t samples = 1, innerColumns = 1;  ///< within a tile
    std::size_t width = 0, height = 0;          ///< of one sample's part, pixels

    [[nodiscard]] std::size_t rows() const { return (tiles + columns - 1) / columns; }
    [[nodiscard]] std::size_t innerRows() const {
        return (samples + innerColumns - 1) / innerColumns;
    }
    [[nodiscard]] std::size_t pictureWidth() const { return columns * innerColumns * width; }
    [[nodiscard]] std::size_t pictureHeight() const { return rows() * innerRows() * height; }
    /// Of the first pixel in a row of one sample's part.
    [[nodiscard]] std::size_t offset(std::size_t tile, std::size_t sample, std::size_t row) const;
};

/// With columns chosen where they are 0, and no more of them than there is to stand beside.
[[nodiscard]] ExrTileLayout chosenLayout(ExrTileLayout layout);

/// The layout of a picture whose columns are not said: nothing unless there is one only of which a
/// pixel's steps of azimuth and radial are the same.
[[nodiscard]] std::optional<ExrTileLayout> guessedLayout(ExrTileLayout layout, Size picture);

/// Azimuths and radials of the pixels' centres, degrees.
[[nodiscard]] std::vector<double> centreDegrees(std::size_t pixels, double span);

/// The number of columns that the table's azimuths are centres of; nothing where they are none.
[[nodiscard]] std::optional<Size> tileSizeOf(const SpecularTable& table);

}  // namespace gonio::proc
