#include "proc/report/plot_request.h"

#include <cmath>

#include "proc/core/number_text.h"

namespace gonio::proc {

std::span<const Band> shownBands(const Scatterer& scatterer) {
    return std::span(kBands).first(scatterer.bandCount() == BandCount::One ? 1 : kBands.size());
}

std::string bandName(Band band) {
    return std::string(1, "RGB"[index(band)]) + " " + fixed(nanometres(band), 0) + " nm";
}

std::string bandLabel(const Scatterer& scatterer, Band band) {
    if (scatterer.bandCount() == BandCount::One) return "monochrome";
    return bandName(band);
}

std::string degreesLabel(Radians angle) {
    const double tenths = std::round(angle.degrees() * 10) / 10 + 0.0;  // no -0
    return shortest(tenths) + " deg";
}

}  // namespace gonio::proc
