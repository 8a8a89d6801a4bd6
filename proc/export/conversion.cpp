#include "proc/export/conversion.h"

#include "proc/core/number_text.h"
#include "proc/export/conversion_steps.h"

namespace gonio::proc {

std::string bandSuffix(Band band) { return "_" + Channel::of(band).name; }

namespace {

/// What is asked of a format that has no choice there.
Result<void> checkWish(const ConversionWish& wish) {
    const std::string what = std::string(factsOf(wish.to).title);
    if (wish.half && wish.to != Format::ExrTiles && wish.to != Format::ExrAtlas) {
        return Error{ErrorKind::Usage, "--half is for exr-tiles and exr-atlas, not for a " + what};
    }
    const bool steps = wish.to == Format::Zemax || wish.to == Format::LightTools ||
                       wish.to == Format::Speos || wish.to == Format::Ssdd ||
                       wish.to == Format::Mbsdf || wish.to == Format::ExrTiles;
    if (wish.grid.stepDeg && !steps) {
        return Error{ErrorKind::Usage, "--grid: a " + what + " has steps of its own"};
    }
    if (wish.grid.incidenceDeg &&
        (wish.to == Format::Merl || wish.to == Format::Utia || wish.to == Format::Mbsdf)) {
        return Error{ErrorKind::Usage, "--grid: a " + what + " has incidences of its own"};
    }
    return {};
}

/// Formats of R, G, B without a place for wavelengths say them among their metadata.
ConversionSource withWavelengths(ConversionSource source, Format to) {
    const bool nowhere = to == Format::ExrTiles || to == Format::Rgl || to == Format::Mbsdf;
    if (!nowhere || source.bands.empty() || !source.about.at("colour").empty()) return source;
    if (!source.about.at(key::kWavelengths).empty()) return source;
    std::string text;
    for (const Band band : source.bands) {
        text += (text.empty() ? "" : " ") + shortest(nanometres(band));
    }
    source.about.set(key::kWavelengths, text);
    return source;
}

}  // namespace

Result<std::vector<ConvertedFile>> convertTo(const ConversionSource& given,
                                             const ConversionWish& wish) {
    if (auto sound = checkWish(wish); !sound) return sound.error();
    const ConversionSource source = withWavelengths(given, wish.to);
    switch (wish.to) {
        case Format::Gonio: return toGonio(source, wish);
        case Format::Zemax: return toZemax(source, wish);
        case Format::ExrTiles: return toExrTiles(source, wish);
        case Format::LightTools:
        case Format::Speos:
        case Format::Ssdd:
        case Format::Utia:
        case Format::Mbsdf: return toSpherical(source, wish);
        case Format::Merl: return toMerl(source, wish);
        case Format::Rgl: return toRgl(source, wish);
        case Format::Bird:
        case Format::Astm:
        case Format::Pab:
        case Format::Alta:
        case Format::Csv: return toRows(source, wish);
        case Format::ExrAtlas:
            return Error{ErrorKind::Usage, "an atlas holds several samples: gonio atlas makes one"};
        case Format::Graw:
        case Format::Rt300s:
        case Format::Klems: break;
    }
    return Error{ErrorKind::Usage,
                 std::string(factsOf(wish.to).title) + " is only read, not written"};
}

}  // namespace gonio::proc
