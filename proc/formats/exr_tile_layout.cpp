#include "proc/formats/exr_tile_layout.h"

#include <algorithm>
#include <cmath>

#include "proc/table/axis.h"

namespace gonio::proc {
namespace {

/// Degrees: axes that went through other units and back.
constexpr double kSame = 1e-6;

}  // namespace

std::size_t ExrTileLayout::offset(std::size_t tile, std::size_t sample, std::size_t row) const {
    const std::size_t x = (tile % columns * innerColumns + sample % innerColumns) * width;
    const std::size_t y = (tile / columns * innerRows() + sample / innerColumns) * height + row;
    return y * pictureWidth() + x;
}

ExrTileLayout chosenLayout(ExrTileLayout layout) {
    const auto nearlySquare = [](std::size_t count, double heightToWidth) {
        const double columns = std::round(std::sqrt(static_cast<double>(count) * heightToWidth));
        return static_cast<std::size_t>(std::clamp(columns, 1.0, static_cast<double>(count)));
    };
    layout.columns = std::min(layout.columns, layout.tiles);
    layout.innerColumns = std::min(layout.innerColumns, layout.samples);
    if (layout.innerColumns == 0) layout.innerColumns = nearlySquare(layout.samples, 1);
    if (layout.columns == 0) {
        const auto part = [](std::size_t pixels, std::size_t parts) {
            return static_cast<double>(pixels) * static_cast<double>(parts);
        };
        layout.columns = nearlySquare(
            layout.tiles,
            part(layout.height, layout.innerRows()) / part(layout.width, layout.innerColumns));
    }
    return layout;
}

std::optional<ExrTileLayout> guessedLayout(ExrTileLayout layout, Size picture) {
    const auto width = static_cast<std::size_t>(picture.width);
    const auto height = static_cast<std::size_t>(picture.height);
    std::optional<ExrTileLayout> found;
    for (layout.columns = 1; layout.columns <= std::min(layout.tiles, width); ++layout.columns) {
        const std::size_t rows = layout.rows();
        if (width % layout.columns != 0 || height % rows != 0) continue;
        layout.width = width / layout.columns;
        layout.height = height / rows;
        if (layout.tiles > 1 && layout.width != 2 * layout.height) continue;
        if (found) return std::nullopt;
        found = layout;
    }
    return found;
}

std::vector<double> centreDegrees(std::size_t pixels, double span) {
    std::vector<double> axis;
    for (std::size_t i = 0; i < pixels; ++i) {
        axis.push_back(span * (static_cast<double>(i) + 0.5) / static_cast<double>(pixels));
    }
    return axis;
}

std::optional<Size> tileSizeOf(const SpecularTable& table) {
    const bool half = table.symmetry == TableSymmetry::PlaneSymmetrical;
    const std::size_t azimuths = table.azimuthDeg.size();
    const std::size_t radials = table.radialDeg.size();
    constexpr std::size_t kMost = 1U << 15;
    if (azimuths == 0 || radials == 0 || azimuths > kMost || radials > kMost ||
        !sameAxis(table.azimuthDeg, centreDegrees(azimuths, half ? 180 : 360), kSame) ||
        !sameAxis(table.radialDeg, centreDegrees(radials, 180), kSame)) {
        return std::nullopt;
    }
    return Size{static_cast<int>(half ? 2 * azimuths : azimuths), static_cast<int>(radials)};
}

}  // namespace gonio::proc
