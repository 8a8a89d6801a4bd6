// Anything as EXR tiles for shaders, and several samples as an atlas.

#include <cmath>

#include "proc/export/atlas.h"
#include "proc/export/conversion_steps.h"
#include "proc/formats/exr_atlas.h"
#include "proc/formats/exr_tiles.h"
#include "proc/table/specular_fill.h"

namespace gonio::proc {
namespace {

struct Tiles {
    SpecularTable table;
    Asked asked;
};

/// Pixels of one degree, or as the grid says.
Tiles askedTiles(const ConversionSource& source, const ConversionWish& wish) {
    const double step = wish.grid.stepOr(1);
    const Size tile{static_cast<int>(std::lround(360 / step)),
                    static_cast<int>(std::lround(180 / step))};
    const SpecularGrid grid = exrTileGrid(incidencesFor(source, wish), tile);
    FilledTable filled = fillBands(*allBands(source), grid);
    return {std::move(filled.table), {filled.nodes, filled.unanswered, filled.extrapolated}};
}

const SpecularTable* ownTiles(const ConversionSource& source, const ConversionWish& wish) {
    if (!mayCopy(source, wish) || source.file->format != Format::ExrTiles) return nullptr;
    return source.file->as<SpecularTable>();
}

}  // namespace

Converted toExrTiles(const ConversionSource& source, const ConversionWish& wish) {
    const SpecularTable* own = ownTiles(source, wish);
    if (own == nullptr) {
        if (auto answers = mustAnswer(source, Format::ExrTiles); !answers) return answers.error();
        if (auto three = mustHaveThree(source, Format::ExrTiles); !three) return three.error();
        if (source.rotationDeg.size() > 1) {
            return Error{ErrorKind::Usage,
                         "tiles hold one rotation of the sample: gonio merge --isotropic, first"};
        }
    }
    const Tiles tiles = own == nullptr ? askedTiles(source, wish) : Tiles{};
    Result<Written> written =
        encodeExrTiles(own != nullptr ? *own : tiles.table, source.about, {.half = wish.half});
    if (!written) return written.error();
    ConvertedFile file = fileOf(std::move(*written));
    if (own == nullptr) {
        addPlainLosses(file.loss, source);
        addResampling(file, source, tiles.asked, Format::ExrTiles);
    }
    return std::vector{std::move(file)};
}

Result<Written> atlasOf(std::span<const ConversionSource> sources, const ConversionWish& wish) {
    std::vector<AtlasSample> samples;
    LossReport loss;
    Asked asked;
    for (const ConversionSource& source : sources) {
        if (auto answers = mustAnswer(source, Format::ExrAtlas); !answers) return answers.error();
        if (auto three = mustHaveThree(source, Format::ExrAtlas); !three) return three.error();
        Tiles tiles = askedTiles(source, wish);
        addPlainLosses(loss, source);
        asked.nodes += tiles.asked.nodes;
        asked.unanswered += tiles.asked.unanswered;
        asked.extrapolated += tiles.asked.extrapolated;
        samples.push_back({std::move(tiles.table), source.about});
    }
    Result<Written> written = encodeExrAtlas(samples, {.half = wish.half});
    if (!written) return written;
    for (LossReport::Item& item : loss.items) written->loss.items.push_back(std::move(item));
    written->loss.add(Loss::Resampled, "values asked at the centres of pixels", asked.nodes);
    written->loss.add(Loss::Masked, "directions without an answer", asked.unanswered);
    written->loss.add(
        Loss::Extrapolated, "values from beyond what was measured", asked.extrapolated);
    return written;
}

}  // namespace gonio::proc
