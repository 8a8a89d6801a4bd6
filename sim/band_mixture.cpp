#include "sim/band_mixture.h"

namespace gonio::sim {

LedBands bandMixture(const LedBands& f, double share) {
    if (share == 0) return f;
    const double r = f[Band::R];
    const double g = f[Band::G];
    const double b = f[Band::B];
    return {{r + share * (g - r), g + share * ((r + b) / 2 - g), b + share * (g - b)}};
}

Answer MixedBands::answer(const LightView& pair) const {
    const Answer pure = surface_->answer(pair);
    return {.f = bandMixture(pure.f, share_), .flags = pure.flags, .source = pure.source};
}

}  // namespace gonio::sim
