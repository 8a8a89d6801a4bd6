#include "proc/export/conversion.h"

#include "proc/export/conversion_steps.h"

namespace gonio::proc {

std::string bandSuffix(Band band) { return "_" + Channel::of(band).name; }

Result<std::vector<ConvertedFile>> convertTo(const ConversionSource& source,
                                             const ConversionWish& wish) {
    switch (wish.to) {
        case Format::Gonio: return toGonio(source, wish);
        case Format::Zemax: return toZemax(source, wish);
        case Format::ExrTiles: break;
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
